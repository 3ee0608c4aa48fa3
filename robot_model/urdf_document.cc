#include "robot_model/urdf_document.h"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <mutex>
#include <optional>
#include <string_view>
#include <vector>

#include "common/error.h"
#include "common/text.h"

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

struct Tag {
  std::string_view text;     // From '<' to before '>'.
  std::string_view element;  // Its name.
  int line = 1;              // From 1.
  bool closing = false;      // </element>
  bool empty = false;        // <element/>
};

// The start and end tags of XML text, in order; comments, declarations and character data are
// passed over. Goes on as well as it can in text that is not well-formed.
class TagReader {
 public:
  explicit TagReader(std::string_view text) : text_(text) {}

  std::optional<Tag> Next() {
    while (true) {
      at_ = text_.find('<', at_);
      if (at_ == std::string_view::npos) return std::nullopt;
      line_ += static_cast<int>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(counted_),
                                           text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n'));
      counted_ = at_;
      const std::string_view rest = text_.substr(at_);
      if (rest.starts_with("<!--")) {
        Skip("-->");
      } else if (rest.starts_with("<![CDATA[")) {
        Skip("]]>");
      } else if (rest.starts_with("<?") || rest.starts_with("<!")) {
        Skip(">");
      } else {
        return Read();
      }
    }
  }

 private:
  void Skip(std::string_view end) {
    at_ = text_.find(end, at_);
    at_ = at_ == std::string_view::npos ? text_.size() : at_ + end.size();
  }

  Tag Read() {
    std::size_t end = at_;
    for (char quote = 0; end < text_.size() && (quote != 0 || text_[end] != '>'); ++end) {
      const char c = text_[end];
      if (quote != 0) {
        if (c == quote) quote = 0;
      } else if (c == '"' || c == '\'') {
        quote = c;
      }
    }
    Tag tag;
    tag.text = text_.substr(at_, end - at_);
    tag.line = line_;
    tag.closing = tag.text.starts_with("</");
    tag.empty = tag.text.ends_with('/');
    const std::string_view name = tag.text.substr(tag.closing ? 2 : 1);
    tag.element = name.substr(0, name.find_first_of(" \t\r\n/"));
    at_ = end;
    return tag;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t counted_ = 0;  // Lines up to here are counted.
  int line_ = 1;
};

// Refuses what urdfdom would pass over in silence, or report without a place: text that is no
// UTF-8, elements that are not closed, and what xacro would have to expand first.
class TagChecker {
 public:
  TagChecker(std::string_view text, const std::string& origin) : origin_(origin) {
    TagReader tags(text);
    while (const auto tag = tags.Next()) Check(*tag);
    if (!open_.empty()) {
      Fail(open_.back().line, fmt::format("<{}> is not closed", open_.back().element));
    }
  }

 private:
  [[noreturn]] void Fail(int line, const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", origin_, line, what));
  }

  void Check(const Tag& tag) {
    if (tag.closing) {
      if (open_.empty() || open_.back().element != tag.element) {
        Fail(tag.line, open_.empty()
                           ? fmt::format("</{}> closes nothing", tag.element)
                           : fmt::format("</{}> stands where <{}> of line {} must be "
                                         "closed first",
                                         tag.element, open_.back().element, open_.back().line));
      }
      open_.pop_back();
      return;
    }
    if (const auto bad = FindInvalidUtf8(tag.text)) {
      Fail(tag.line, fmt::format("<{}>: the byte {} is no UTF-8; the file must be UTF-8 text",
                                 tag.element, tag.text.substr(*bad, 1)));
    }
    RefuseXacro(tag);
    if (!tag.empty) open_.push_back(tag);
  }

  void RefuseXacro(const Tag& tag) const {
    // The last four are xacro of before it had a namespace.
    const bool is_xacro =
        tag.element.starts_with("xacro:") ||
        (open_.size() == 1 && (tag.element == "include" || tag.element == "macro" ||
                               tag.element == "property" || tag.element == "insert_block"));
    std::string what;
    if (is_xacro) {
      what = fmt::format("<{}> is xacro and not expanded", tag.element);
    } else if (Within("link") || Within("joint") || tag.element == "link" ||
               tag.element == "joint") {
      for (const std::string_view begin : {"${", "$("}) {
        const std::size_t at = tag.text.find(begin);
        if (at == std::string_view::npos) continue;
        const std::size_t end = tag.text.find(begin == "${" ? '}' : ')', at);
        what = fmt::format("{}<{}>: '{}' is xacro and not expanded", Place(), tag.element,
                           tag.text.substr(at, end - at + 1));
        break;
      }
    }
    if (what.empty()) return;
    Fail(tag.line,
         fmt::format("{}; expand the file first: xacro {} > expanded.urdf", what, origin_));
  }

  bool Within(std::string_view element) const {
    return open_.size() > 1 && open_[1].element == element;
  }

  // "link 'name': " inside a link or joint.
  std::string Place() const {
    if (!Within("link") && !Within("joint")) return "";
    return fmt::format("{} '{}': ", open_[1].element,
                       Attribute(open_[1].text, "name").value_or(""));
  }

  const std::string& origin_;
  std::vector<Tag> open_;
};

// Notes where links and joints are defined.
void FindElements(std::string_view text, UrdfDocument* document) {
  TagReader tags(text);
  int order = 0;
  while (const auto tag = tags.Next()) {
    const std::optional<std::string> name = Attribute(tag->text, "name");
    if (!name || tag->closing) continue;
    if (tag->element == "link") {
      document->link_lines.try_emplace(*name, tag->line);
    } else if (tag->element == "joint" && Attribute(tag->text, "type")) {
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
  const TagChecker checked(urdf_text, origin);
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
