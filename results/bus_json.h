#pragma once

#include <filesystem>
#include <string>

namespace planbench {

// What was odd on the bus while a session folder was written: "bus" of its run.json, a JSON object
// of counts and of a list of contradictions; "" if nothing was.

/// Counts event logs of which nothing of this is told: a logger counts until it ends, and what is
/// made of a log alone knows of no bus.
inline constexpr char kLogsNotToldOf[] = "logs_not_told_of";
/// Of one such log.
inline constexpr char kBusNotTold[] = R"({"logs_not_told_of":1})";

/// Throws InputError naming the file if it is none that a logger wrote.
std::string ReadBusJson(const std::filesystem::path& run_json);

/// Whether anything is told of the bus, be it that nothing was odd: not if that is only of how many
/// logs nothing is. Throws InputError as AddBusJson does.
bool IsToldOf(const std::string& bus);

/// Both together: counts added up, contradictions one after the other. Throws InputError if one is
/// none of ReadBusJson's.
std::string AddBusJson(const std::string& first, const std::string& second);

/// What AddBusJson added to `part` to make `all` of it, without counts of 0. Throws InputError as
/// that does.
std::string WithoutBusJson(const std::string& all, const std::string& part);

/// Has the run.json of a folder tell that, whatever it told. Throws InputError if it cannot be
/// written.
void WriteBusJson(const std::filesystem::path& run_json, const std::string& bus);

}  // namespace planbench
