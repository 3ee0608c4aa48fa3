#include "common/command_line.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <system_error>

#include "common/error.h"
#include "common/exit_codes.h"
#include "common/standard_output.h"
#include "common/text.h"
#include "common/version.h"

namespace planbench {

void AddVersionFlag(CLI::App* app) {
  app->set_version_flag("--version", app->get_name() + " " + Version() + " (" + Commit() + ")");
}

CLI::Validator AnySeed() {
  return CLI::Validator(
      [](std::string& text) {
        std::uint64_t value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error == std::errc() && end == text.data() + text.size()) return std::string();
        return fmt::format("'{}' is no whole number from 0 to {}", text,
                           std::numeric_limits<std::uint64_t>::max());
      },
      "");
}

CLI::Validator Positive(double most) {
  return CLI::Validator(
      [most](std::string& text) -> std::string {
        const double value = std::strtod(text.c_str(), nullptr);  // 0 if it is none
        if (value > 0 && value <= most) return "";
        return most == std::numeric_limits<double>::max()
                   ? fmt::format("{} is no finite number greater than zero", text)
                   : fmt::format("{} is not greater than zero and at most {}", text, most);
      },
      "");
}

CLI::Validator Within(double least, double most) {
  return CLI::Validator(
      [least, most](std::string& text) -> std::string {
        const double value = std::strtod(text.c_str(), nullptr);  // 0 if it is none
        if (value >= least && value <= most) return "";
        return fmt::format("{} is not from {} to {}", text, least, most);
      },
      "");
}

namespace {

/// Of what is given nothing is empty text: it names no file, no bus and nobody. (CLI11 refuses it
/// behind an equals sign alone.)
void RequireNotEmpty(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& text : option->results()) {
      if (text.empty()) throw InputError(option->get_name() + ": the text given is empty");
    }
  }
}

int ParseAndWork(CLI::App* app, int argc, char** argv, const std::function<int()>& work) {
  const std::string& name = app->get_name();
  try {
    // What is given goes into messages, databases and JSON.
    for (int i = 1; i < argc; ++i) {
      if (FindInvalidUtf8(argv[i])) throw InputError(std::string(argv[i]) + ": is no UTF-8 text");
    }
    app->parse(argc, argv);
    RequireNotEmpty(*app);
    return work();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app->exit(error);  // --help, --version
    std::cerr << name << ": " << error.what() << " (see " << name << " --help)\n";
    return kExitBadInput;
  } catch (const InputError& error) {
    std::cerr << name << ": " << error.what() << "\n";
    return kExitBadInput;
  } catch (const std::exception& error) {
    std::cerr << name << ": failed: " << error.what() << "\n";
    return kExitFailed;
  }
}

}  // namespace

int RunCommand(CLI::App* app, int argc, char** argv, const std::function<int()>& work) {
  app->footer(
      "Exit code: 0; 1: ran, but something failed; 2: bad use or bad input; 128 + N, as shells "
      "tell "
      "it: ended by signal N.");
  const int code = ParseAndWork(app, argc, argv, work);
  const std::string fault = StandardOutputFault();
  if (fault.empty()) return code;
  std::cerr << app->get_name() << ": failed: " << fault << "\n";
  return code == kExitOk ? kExitFailed : code;
}

}  // namespace planbench
