#include "robot_model/urdf_document.h"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <mutex>
#include <optional>
#include <string_view>

#include "common/error.h"

namespace planbench {
namespace {

// Keeps what urdfdom reports while it lives, instead of letting it go to the terminal. The handler
// is process-wide in console_bridge: one capture at a time.
class ReportCapture : private console_bridge::OutputHandler {
 public:
  ReportCapture() : lock_(Mutex()) { console_bridge::useOutputHandler(this); }
  ~ReportCapture() override { console_bridge::restorePreviousOutputHandler(); }

  /// Everything reported as an error, in one line.
  const std::string& errors() const { return errors_; }

 private:
  static std::mutex& Mutex() {
    static std::mutex mutex;
    return mutex;
  }

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR) return;
    if (!errors_.empty()) errors_ += "; ";
    for (const char c : text) errors_ += c == '\n' ? ' ' : c;
  }

  std::lock_guard<std::mutex> lock_;
  std::string errors_;
};

bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

// The value of an attribute in the text of a start tag, nothing if it has none of that name.
std::optional<std::string> Attribute(std::string_view tag, std::string_view name) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    if (at == 0 || !IsSpace(tag[at - 1])) continue;
    std::size_t i = at + name.size();
    while (i < tag.size() && IsSpace(tag[i])) ++i;
    if (i >= tag.size() || tag[i] != '=') continue;
    ++i;
    while (i < tag.size() && IsSpace(tag[i])) ++i;
    if (i >= tag.size() || (tag[i] != '"' && tag[i] != '\'')) continue;
    const std::size_t end = tag.find(tag[i], i + 1);
    if (end == std::string_view::npos) return std::nullopt;
    return std::string(tag.substr(i + 1, end - i - 1));
  }
  return std::nullopt;
}

// Notes where links and joints are defined. The text is known to be well-formed XML.
void FindElements(std::string_view text, UrdfDocument* document) {
  int line = 1;
  std::size_t counted = 0;
  int order = 0;
  for (std::size_t begin = text.find('<'); begin != std::string_view::npos;
       begin = text.find('<', begin)) {
    if (text.substr(begin).starts_with("<!--")) {
      begin = std::min(text.find("-->", begin), text.size());
      continue;
    }
    const std::size_t end = std::min(text.find('>', begin), text.size());
    const std::string_view tag = text.substr(begin, end - begin);
    line += static_cast<int>(std::count(text.begin() + static_cast<std::ptrdiff_t>(counted),
                                        text.begin() + static_cast<std::ptrdiff_t>(begin), '\n'));
    counted = begin;
    begin = end;
    const std::size_t name_end = std::min(tag.find_first_of(" \t\r\n/"), tag.size());
    const std::string_view element = tag.substr(0, name_end);
    if (element == "<link") {
      if (const auto name = Attribute(tag, "name")) document->link_lines.try_emplace(*name, line);
    } else if (element == "<joint") {
      // Transmissions mention joints by the same tag, without a type.
      const auto name = Attribute(tag, "name");
      if (!name || !Attribute(tag, "type")) continue;
      document->joint_lines.try_emplace(*name, line);
      document->joint_order.try_emplace(*name, order++);
    }
  }
}

}  // namespace

UrdfDocument ParseUrdfDocument(const std::string& urdf_text, const std::string& origin) {
  UrdfDocument document;
  std::string errors;
  {
    const ReportCapture capture;
    try {
      document.model = urdf::parseURDF(urdf_text);
    } catch (const std::exception& error) {
      // Some malformed attributes (the version's) come out as exceptions of urdfdom's own.
      throw InputError(fmt::format("{}: not a valid URDF: {}", origin, error.what()));
    }
    errors = capture.errors();
  }
  // urdfdom goes on without a collision geometry that it cannot parse; the robot would then be
  // smaller than meant, so that an error it reports is one even where it returns a model.
  if (document.model == nullptr || !errors.empty()) {
    throw InputError(fmt::format("{}: not a valid URDF: {}", origin,
                                 errors.empty() ? "urdfdom gives no reason" : errors));
  }
  FindElements(urdf_text, &document);
  return document;
}

}  // namespace planbench
