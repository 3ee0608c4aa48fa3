#include "messaging/channels.h"

#include <algorithm>
#include <cctype>

#include "common/error.h"

namespace planbench {

bool IsNodeName(std::string_view name) {
  return !name.empty() && name.size() <= 40 &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; });
}

void RequireNodeName(const std::string& name) {
  if (!IsNodeName(name)) {
    throw InputError("'" + name + "' cannot name a node: " + kNodeNameRule);
  }
}

PlannerChannels::PlannerChannels(const std::string& planner) {
  RequireNodeName(planner);
  std::string suffix = planner;
  std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) {
    return c == '-' ? '_' : static_cast<char>(std::toupper(c));
  });
  request = "PLAN_REQUEST_" + suffix;
  ack = "PLAN_ACK_" + suffix;
  progress = "PLAN_PROGRESS_" + suffix;
  result = "PLAN_RESULT_" + suffix;
  cancel = "PLAN_CANCEL_" + suffix;
}

}  // namespace planbench
