#include "results/bus_json.h"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "common/error.h"
#include "common/read_text.h"
#include "common/write_file.h"

namespace planbench {
namespace {

// Keeps the order in which keys are written, for the reader's sake.
using Json = nlohmann::ordered_json;

constexpr char kBus[] = "bus";

/// Calls `visit` with what the object has; throws InputError if it, or `visit`, finds none of a
/// logger's.
template <typename Visit>
void ForEachEntry(const std::string& bus, Visit visit) {
  if (bus.empty()) return;
  try {
    const Json told = Json::parse(bus);  // must outlive what goes over it
    for (const auto& [name, value] : told.items()) visit(name, value);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(std::string("what is told of the bus is none of a logger's: ") + error.what());
  }
}

}  // namespace

std::string ReadBusJson(const std::filesystem::path& run_json) {
  try {
    const Json run = Json::parse(ReadText(run_json));
    if (!run.is_object()) throw InputError("is no JSON object");
    if (!run.contains(kBus)) return "";
    return AddBusJson(run.at(kBus).dump(), "");
  } catch (const nlohmann::json::exception& error) {
    throw InputError(run_json.string() + ": is none that a logger wrote: " + error.what());
  } catch (const InputError& error) {
    throw InputError(run_json.string() + ": " + error.what());
  }
}

bool IsToldOf(const std::string& bus) {
  const std::string told = WithoutBusJson(bus, "");
  if (told.empty()) return true;
  const Json odd = Json::parse(told);
  return odd.size() > 1 || !odd.contains(kLogsNotToldOf);
}

std::string AddBusJson(const std::string& first, const std::string& second) {
  Json sum = Json::object();
  for (const std::string& bus : {first, second}) {
    ForEachEntry(bus, [&](const std::string& name, const Json& value) {
      if (value.is_array()) {
        for (const Json& one : value) sum[name].push_back(one);
      } else {
        sum[name] = sum.value(name, std::int64_t{0}) + value.get<std::int64_t>();
      }
    });
  }
  return sum.empty() ? "" : sum.dump();
}

std::string WithoutBusJson(const std::string& all, const std::string& part) {
  Json rest = Json::object();
  ForEachEntry(all, [&](const std::string& name, const Json& value) { rest[name] = value; });
  ForEachEntry(part, [&](const std::string& name, const Json& value) {
    if (value.is_array()) {
      for (const Json& one : value) {
        const auto found = std::find(rest[name].begin(), rest[name].end(), one);
        if (found != rest[name].end()) rest[name].erase(found);
      }
    } else {
      rest[name] = rest.value(name, std::int64_t{0}) - value.get<std::int64_t>();
    }
  });
  Json odd = Json::object();
  for (const auto& [name, value] : rest.items()) {
    if (value.is_array() ? !value.empty() : value > 0) odd[name] = value;
  }
  return odd.empty() ? "" : odd.dump();
}

void WriteBusJson(const std::filesystem::path& run_json, const std::string& bus) {
  Json run = Json::parse(ReadText(run_json));
  run.erase(kBus);
  if (!bus.empty()) run[kBus] = Json::parse(bus);
  WriteFile(run_json, run.dump(2) + "\n");
}

}  // namespace planbench
