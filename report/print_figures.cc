#include "report/print_figures.h"

#include <fmt/format.h>

#include <cstdlib>
#include <iostream>
#include <stdexcept>

#include "common/error.h"
#include "common/write_file.h"
#include "report/web_files.h"
#include "results/shell_quoted.h"

namespace planbench {
namespace {

bool IsInstalled(const char* program) {
  return std::system(fmt::format("command -v {} >/dev/null", program).c_str()) == 0;
}

void Run(const std::string& command) {
  if (std::system(command.c_str()) != 0) throw std::runtime_error("failed: " + command);
}

std::string Script() {
  // The printed page is white: the colours are those of the light theme, the first in page.css.
  std::string script = VegaModules();
  script += WebFile("vega.js");
  script += WebFile("palette.js");
  script += fmt::format(
      "const pageCss = {};\n"
      "const theme = makePalette(name => pageCss.match(new RegExp(name + \": ([^;]*);\"))[1]);\n",
      Json(std::string(WebFile("page.css"))).dump());
  for (const char* name : {"charts.js", "figures.js", "print.js"}) script += WebFile(name);
  return script;
}

}  // namespace

void PrintFigures(const Json& data, const std::filesystem::path& folder) {
  if (!IsInstalled("node")) throw InputError("--figures needs node: apt-get install nodejs");
  const std::filesystem::path script = folder / "figures.js";
  const std::filesystem::path numbers = folder / "figures.json";
  WriteFile(script, Script());
  WriteFile(numbers, data.dump(-1, ' ', false, Json::error_handler_t::replace));
  Run(fmt::format("node {} {} {}", ShellQuoted(script.string()), ShellQuoted(numbers.string()),
                  ShellQuoted(folder.string())));
  std::filesystem::remove(script);
  std::filesystem::remove(numbers);
  if (!IsInstalled("rsvg-convert")) {
    std::cerr << "report: no PDF of the figures: rsvg-convert is missing (apt-get install "
                 "librsvg2-bin)\n";
    return;
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".svg") continue;
    std::filesystem::path pdf = entry.path();
    pdf.replace_extension(".pdf");
    Run(fmt::format("rsvg-convert -f pdf -o {} {}", ShellQuoted(pdf.string()),
                    ShellQuoted(entry.path().string())));
  }
}

}  // namespace planbench
