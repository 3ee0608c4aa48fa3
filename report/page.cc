#include "report/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "report/web_files.h"

namespace planbench {
namespace {

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

/// JSON in a script element: the one character that HTML could take for markup is escaped, which
/// JSON allows in strings, and it stands nowhere else.
std::string DataElement(const std::string& id, const Json& data) {
  const std::string text = data.dump(-1, ' ', false, Json::error_handler_t::replace);
  return fmt::format("<script type=\"application/json\" id=\"{}\">{}</script>\n", id,
                     ReplaceAll(text, "<", "\\u003c"));
}

/// three.js, as the global THREE.
std::string ThreeScripts() {
  std::string text = "<!-- three.js: copyright three.js authors, MIT license -->\n";
  for (const EmbeddedFile& file : ThreeFiles()) text += ScriptElement(file.text);
  return text;
}

std::string Page(std::string_view html, const std::string& scripts) {
  const std::string page = ReplaceAll(html, "/* page.css */", WebFile("page.css"));
  return ReplaceAll(page, "<!-- scripts -->", scripts);
}

}  // namespace

std::string ReportPage(const Json& data, const EmbeddedViews& views) {
  std::vector<std::string> notes = views.notes;
  if (!views.extent.empty()) notes.push_back(views.extent);
  std::string scripts = DataElement("data", data) + DataElement("view-notes", notes);
  // Each in an element of its own: read when it is looked at.
  for (const auto& [attempt, view] : views.by_attempt) {
    scripts += DataElement(fmt::format("view-{}", attempt), view);
  }
  for (const auto& [id, mesh] : views.meshes) scripts += DataElement("mesh-" + id, mesh);
  if (!views.by_attempt.empty()) scripts += ThreeScripts();
  scripts +=
      "<!-- Vega: copyright University of Washington Interactive Data Lab, BSD-3-Clause -->\n";
  scripts += ScriptElement(VegaModules());
  for (const char* name : {"vega.js", "palette.js", "theme.js", "charts.js", "figures.js",
                           "pictures.js", "viewer.js", "page.js"}) {
    scripts += ScriptElement(WebFile(name));
  }
  return Page(WebFile("page.html"), scripts);
}

std::size_t RoomForViews(const Json& data) {
  EmbeddedViews one;  // with which three.js comes
  one.by_attempt[0] = nullptr;
  return kMostPageBytes - std::min(kMostPageBytes, ReportPage(data, one).size());
}

std::string PageWithViews(std::string_view html, const std::string& data, std::string_view script) {
  std::string scripts = data + ThreeScripts();
  for (const char* name : {"palette.js", "theme.js", "viewer.js"}) {
    scripts += ScriptElement(WebFile(name));
  }
  return Page(html, scripts + ScriptElement(script));
}

std::string ViewPage(const Json& view) {
  return PageWithViews(WebFile("view.html"), DataElement("data", view), WebFile("view.js"));
}

}  // namespace planbench
