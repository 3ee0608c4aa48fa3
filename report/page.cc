#include "report/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "report/web_files.h"

namespace planbench {
namespace {

std::string_view WebFile(std::string_view name) {
  for (const EmbeddedFile& file : WebFiles()) {
    if (file.name == name) return file.text;
  }
  throw std::logic_error(fmt::format("no file {} in report/web", name));
}

std::string ReplaceAll(std::string_view text, std::string_view from, std::string_view to) {
  std::string replaced;
  for (std::size_t at; (at = text.find(from)) != std::string_view::npos;) {
    replaced.append(text.substr(0, at)).append(to);
    text.remove_prefix(at + from.size());
  }
  return replaced.append(text);
}

/// A script's text may not end the element that holds it.
std::string ScriptElement(std::string_view text) {
  return "<script>\n" + ReplaceAll(text, "</script", "<\\/script") + "\n</script>\n";
}

/// Debian has Vega as CommonJS modules, which modules.js joins.
std::string VegaModules() {
  std::string text;
  for (const EmbeddedFile& file : VegaFiles()) {
    const std::string_view name = file.name.substr(0, file.name.find('.'));
    text +=
        fmt::format("planbenchModules[\"{}\"] = function (exports, require, module) {{\n{}\n}};\n",
                    name, file.text);
  }
  return text;
}

/// JSON in a script element: the one character that HTML could take for markup is escaped, which
/// JSON allows in strings, and it stands nowhere else.
std::string DataElement(const Json& data) {
  const std::string text = data.dump(-1, ' ', false, Json::error_handler_t::replace);
  return "<script type=\"application/json\" id=\"data\">" + ReplaceAll(text, "<", "\\u003c") +
         "</script>\n";
}

}  // namespace

std::string ReportPage(const Json& data) {
  std::string scripts = DataElement(data);
  scripts +=
      "<!-- Vega: copyright University of Washington Interactive Data Lab, BSD-3-Clause -->\n";
  scripts += ScriptElement(std::string(WebFile("modules.js")) + VegaModules());
  for (const char* name : {"theme.js", "charts.js", "page.js"}) {
    scripts += ScriptElement(WebFile(name));
  }
  const std::string page = ReplaceAll(WebFile("page.html"), "/* page.css */", WebFile("page.css"));
  return ReplaceAll(page, "<!-- scripts -->", scripts);
}

}  // namespace planbench
