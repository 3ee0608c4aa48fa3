#pragma once

#include <map>
#include <string>
#include <vector>

#include "benchmark_driver/driver_options.h"

namespace CLI {
class App;
}

namespace planbench {

/// Adds the driver's flags, which fill `options`. Parsing throws CLI::ParseError or InputError,
/// both naming the flag.
void AddDriverFlags(CLI::App* app, DriverOptions* options);

/// Flags of a parsed command line and their values, defaults included, for the record: files and
/// folders are absolute, names of robots that ship stay as they are.
std::map<std::string, std::string> FlagsOf(const CLI::App& app);

/// "1-20", "3", "1-5,8,10-12" -> indices, ascending, without repetitions; throws InputError.
std::vector<int> ParseRange(const std::string& text, const std::string& flag = "--problems-range");

/// "2/8"; throws InputError.
Shard ParseShard(const std::string& text);

}  // namespace planbench
