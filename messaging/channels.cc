#include "messaging/channels.h"

#include <algorithm>
#include <cctype>

#include "common/error.h"

namespace planbench {

void RequireNodeName(const std::string& name) {
  const bool characters_ok = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
  if (name.empty() || name.size() > 40 || !characters_ok) {
    throw InputError("'" + name +
                     "' cannot name a node: 1 to 40 letters, digits, '_' or '-' are needed");
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
  result_ack = "PLAN_RESULT_ACK_" + suffix;
  cancel = "PLAN_CANCEL_" + suffix;
}

}  // namespace planbench
