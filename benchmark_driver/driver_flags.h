#pragma once

#include <map>
#include <string>
#include <vector>

#include "benchmark_driver/driver_options.h"

namespace CLI {
class App;
}

namespace planbench {

/// The flags as text, and what becomes of them.
class DriverFlags {
 public:
  void AddTo(CLI::App* app);
  /// Throws InputError naming the flag.
  DriverOptions Parse() const;
  /// Flags and values, for the record.
  std::map<std::string, std::string> AsSettings(const DriverOptions& options) const;

 private:
  std::string sets_;
  std::string range_;
  std::string planners_ = "ara,rrtc";
  std::string directions_ = "both";
  std::string edge_check_;
  std::string collision_model_ = "spheres";
  std::vector<std::string> problems_;
  std::vector<std::string> planner_commands_;
  std::vector<std::string> planner_settings_;
  DriverOptions options_;
};

/// "1-20", "3", "1-5,8,10-12" -> indices, ascending, without repetitions; throws InputError.
std::vector<int> ParseRange(const std::string& text);

}  // namespace planbench
