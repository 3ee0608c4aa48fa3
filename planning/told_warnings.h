#pragma once

#include <map>
#include <string>
#include <vector>

namespace planbench {

/// Of what a session's scene server tells warnings among its settings, for whoever reads its
/// results: the robots that it loaded, and, which the driver adds, the problems that it served and
/// the planners that were asked.
inline constexpr char kRobotWarning[] = "robot warning";
inline constexpr char kProblemWarning[] = "problem warning";
inline constexpr char kPlannerWarning[] = "planner warning";

/// Tells warnings of a kind, a line each, in the order they come: "robot warning 01" and so on,
/// after those told before, each once. Of more than 40 the last line says that there are more.
void TellWarnings(const std::string& kind, const std::vector<std::string>& warnings,
                  std::map<std::string, std::string>* settings);

/// Those of a kind that settings tell, in order.
std::vector<std::string> ToldWarnings(const std::string& kind,
                                      const std::map<std::string, std::string>& settings);

}  // namespace planbench
