#include "robot_model/urdf_document.h"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include <mutex>
#include <optional>
#include <string_view>
#include <vector>

#include "common/error.h"
#include "robot_model/xml_text.h"

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

// Notes where links and joints are defined.
void FindElements(std::string_view text, UrdfDocument* document) {
  XmlTagReader tags(text);
  int order = 0;
  while (const auto tag = tags.Next()) {
    const std::optional<std::string> name = tag->Attribute("name");
    if (!name || tag->closing) continue;
    if (tag->element == "link") {
      document->link_lines.try_emplace(*name, tag->line);
    } else if (tag->element == "joint" && tag->Attribute("type")) {
      // Transmissions mention joints by the same tag, without a type.
      document->joint_lines.try_emplace(*name, tag->line);
      document->joint_order.try_emplace(*name, order++);
    }
  }
}

// ":LINE" of the first link or joint that urdfdom's report names, in brackets or quotes; "" if it
// names none.
std::string LineOfReport(const std::string& report, const UrdfDocument& document) {
  std::size_t first = std::string::npos;
  int line = 0;
  for (const auto* lines : {&document.joint_lines, &document.link_lines}) {
    for (const auto& [name, at_line] : *lines) {
      for (const auto& quoted : {"[" + name + "]", "'" + name + "'"}) {
        const std::size_t at = report.find(quoted);
        if (at >= first) continue;
        first = at;
        line = at_line;
      }
    }
  }
  return first == std::string::npos ? "" : fmt::format(":{}", line);
}

}  // namespace

UrdfDocument ParseUrdfDocument(const std::string& urdf_text, const std::string& origin) {
  CheckXmlText(urdf_text, origin);
  UrdfDocument document;
  FindElements(urdf_text, &document);
  std::string errors;
  const auto fail = [&](const std::string& report) {
    throw InputError(
        fmt::format("{}{}: not a valid URDF: {}", origin, LineOfReport(report, document), report));
  };
  {
    const ReportCapture capture;
    try {
      document.model = urdf::parseURDF(urdf_text);
    } catch (const std::exception& error) {
      // Some malformed attributes (the version's) come out as exceptions of urdfdom's own.
      fail(error.what());
    }
    errors = capture.errors();
  }
  // urdfdom goes on without a collision geometry that it cannot parse; the robot would then be
  // smaller than meant, so that an error it reports is one even where it returns a model.
  if (document.model == nullptr || !errors.empty()) {
    fail(errors.empty() ? "urdfdom gives no reason" : errors);
  }
  return document;
}

}  // namespace planbench
