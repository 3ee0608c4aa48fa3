#include "report/session_shares.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/error.h"
#include "results/bus_json.h"
#include "results/reproduce.h"

namespace planbench {
namespace {

constexpr char kTotalTime[] = "total_time_s";
constexpr char kBus[] = "bus";
/// How the id of what a merged session went on with begins; those of its parts follow.
constexpr char kAfter[] = "after";

/// The last words of a session, and those with which it was merged, if it was.
struct Told {
  const SessionMessage* last = nullptr;
  const SessionMessage* merged = nullptr;
};

std::map<std::string, Told> ByRunId(const std::vector<SessionMessage>& messages) {
  std::map<std::string, Told> sessions;
  for (const SessionMessage& message : messages) {
    Told& told = sessions[message.run_id];
    if (told.last == nullptr || SessionOrder(*told.last) <= SessionOrder(message)) {
      told.last = &message;
    }
    if (message.settings.contains(kMergedParts)) told.merged = &message;
  }
  return sessions;
}

}  // namespace

void SessionShares::Add(const std::vector<SessionMessage>& told,
                        const std::optional<std::string>& bus) {
  std::string own_bus = bus.value_or(kBusNotTold);
  std::vector<std::pair<std::string, double>> own;  // id and s
  for (const auto& [run_id, session] : ByRunId(told)) {
    std::string id = run_id;
    double own_s = session.last->total_time_s;
    if (session.merged != nullptr) {
      id = kAfter;
      for (const auto& [part, share] : Parse(session.merged->settings.at(kMergedParts))) {
        Keep(part, share);
        id += " " + part;
        own_s -= share.total_time_s;
        if (bus) own_bus = WithoutBusJson(own_bus, share.bus);
      }
    }
    if (session.last != session.merged) own.emplace_back(id, std::max(0.0, own_s));
  }
  // Of several sessions of a folder it is not known which was on when something was lost.
  for (const auto& [id, own_s] : own) Keep(id, {own_s, std::exchange(own_bus, "")});
}

std::set<std::string> SessionShares::MergedRunIds(const std::map<std::string, std::string>& flags) {
  std::set<std::string> run_ids;
  for (const char* setting : {kMergedParts, kHeldParts}) {
    const auto parts = flags.find(setting);
    if (parts == flags.end()) continue;
    for (const auto& [id, share] : Parse(parts->second)) {
      if (!id.starts_with(std::string(kAfter) + " ")) run_ids.insert(id);
    }
  }
  return run_ids;
}

double SessionShares::total_time_s() const {
  double sum_s = 0;
  for (const auto& [id, share] : by_id_) sum_s += share.total_time_s;
  return sum_s;
}

std::string SessionShares::bus() const {
  std::string sum;
  for (const auto& [id, share] : by_id_) sum = AddBusJson(sum, share.bus);
  return sum;
}

std::string SessionShares::Text() const {
  nlohmann::json text = nlohmann::json::object();
  for (const auto& [id, share] : by_id_) {
    text[id] = {{kTotalTime, share.total_time_s}, {kBus, share.bus}};
  }
  return text.dump();
}

std::map<std::string, SessionShares::Share> SessionShares::Parse(const std::string& text) {
  std::map<std::string, Share> shares;
  try {
    const auto parts = nlohmann::json::parse(text);
    for (const auto& [id, part] : parts.items()) {
      shares[id] = {part.at(kTotalTime).get<double>(), part.at(kBus).get<std::string>()};
    }
  } catch (const nlohmann::json::exception& error) {
    throw InputError(std::string("the setting ") + kMergedParts +
                     " is none that --merge wrote: " + error.what());
  }
  return shares;
}

/// A session that went on tells of more time, and with that of what it lost since.
void SessionShares::Keep(const std::string& id, const Share& share) {
  const auto [place, is_new] = by_id_.try_emplace(id, share);
  if (is_new) return;
  Share& known = place->second;
  const bool is_later = share.total_time_s > known.total_time_s && !share.bus.empty();
  if (!IsToldOf(known.bus) || (IsToldOf(share.bus) && (is_later || known.bus.empty()))) {
    known.bus = share.bus;
  }
  known.total_time_s = std::max(known.total_time_s, share.total_time_s);
}

}  // namespace planbench
