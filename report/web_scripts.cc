#include <fmt/format.h>

#include <stdexcept>

#include "report/web_files.h"

namespace planbench {

std::string_view WebFile(std::string_view name) {
  for (const EmbeddedFile& file : WebFiles()) {
    if (file.name == name) return file.text;
  }
  throw std::logic_error(fmt::format("no file {} in report/web", name));
}

std::string VegaModules() {
  std::string text(WebFile("modules.js"));
  for (const EmbeddedFile& file : VegaFiles()) {
    const std::string_view name = file.name.substr(0, file.name.find('.'));
    text +=
        fmt::format("planbenchModules[\"{}\"] = function (exports, require, module) {{\n{}\n}};\n",
                    name, file.text);
  }
  return text;
}

}  // namespace planbench
