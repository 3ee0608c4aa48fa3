#include "report/print_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/error.h"
#include "common/read_text.h"
#include "common/scratch_folder.h"
#include "common/write_file.h"
#include "report/output_folder.h"
#include "report/web_files.h"
#include "results/shell_quoted.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

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

/// Whether figures of these kinds are called so on any set, as print.js names them.
bool IsFigure(const std::vector<std::string>& kinds, const fs::path& name) {
  if (name.extension() != ".svg" && name.extension() != ".pdf") return false;
  const std::string stem = name.stem().string();
  return std::any_of(kinds.begin(), kinds.end(), [&](const std::string& kind) {
    return stem.starts_with(kind + "-") &&
           std::all_of(stem.begin() + static_cast<std::ptrdiff_t>(kind.size()), stem.end(),
                       [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
  });
}

}  // namespace

void PrintFigures(const Json& data, const fs::path& folder) {
  if (!IsInstalled("node")) throw InputError("--figures needs node: apt-get install nodejs");
  const ScratchFolder scratch(TemporaryFiles() / "planbench-figures-");
  const fs::path script = scratch.path() / "figures.js";
  const fs::path numbers = scratch.path() / "figures.json";
  WriteFile(script, Script());
  WriteFile(numbers, data.dump(-1, ' ', false, Json::error_handler_t::replace));
  Run(fmt::format("node {} {} {}", ShellQuoted(script.string()), ShellQuoted(numbers.string()),
                  ShellQuoted(scratch.path().string())));
  const std::vector<std::string> kinds = Json::parse(ReadText(scratch.path() / "kinds.json"));
  const bool has_pdf = IsInstalled("rsvg-convert");
  const auto write = [&](const fs::path& new_folder) {
    for (const auto& entry : fs::directory_iterator(scratch.path())) {
      if (entry.path().extension() != ".svg") continue;
      const fs::path svg = new_folder / entry.path().filename();
      WriteFile(svg, ReadText(entry.path()));
      if (!has_pdf) continue;
      fs::path pdf = svg;
      pdf.replace_extension(".pdf");
      Run(fmt::format("rsvg-convert -f pdf -o {} {}", ShellQuoted(pdf.string()),
                      ShellQuoted(svg.string())));
    }
  };
  ReplaceFiles(
      folder, [&](const std::string& name) { return IsFigure(kinds, name); }, write);
  if (!has_pdf) {
    std::cerr << "report: no PDF of the figures: rsvg-convert is missing (apt-get install "
                 "librsvg2-bin)\n";
  }
}

}  // namespace planbench
