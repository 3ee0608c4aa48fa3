#include "robot_model/xml_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

#include "common/error.h"
#include "common/text.h"
#include "geometry/text_words.h"

namespace planbench {
namespace {

bool NamesXacro(std::string_view uri) { return uri.ends_with("/xacro"); }

// Before the colon, "" without one.
std::string_view PrefixOf(std::string_view name) {
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? "" : name.substr(0, colon);
}

// Of a start tag what is no attribute; empty if all is well.
std::string_view NoAttribute(const XmlTag& tag) {
  constexpr std::string_view kSpaces = " \t\r\n";
  std::string_view rest = tag.text.substr(1 + tag.element.size());
  if (tag.empty) rest.remove_suffix(1);
  for (const XmlAttribute& attribute : tag.Attributes()) {
    const auto begin = static_cast<std::size_t>(attribute.name.data() - rest.data());
    if (begin == 0 || rest.find_first_not_of(kSpaces) != begin) return rest;
    rest.remove_prefix(static_cast<std::size_t>(attribute.value.data() + attribute.value.size() +
                                                1 - rest.data()));
  }
  return rest.substr(std::min(rest.find_first_not_of(kSpaces), rest.size()));
}

class TagChecker {
 public:
  TagChecker(std::string_view text, const std::string& origin) : origin_(origin) {
    XmlTagReader tags(text);
    while (const auto tag = tags.Next()) Check(*tag);
    if (!open_.empty()) {
      Fail(open_.back().line, fmt::format("<{}> is not closed", open_.back().element));
    }
  }

 private:
  [[noreturn]] void Fail(int line, const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", origin_, line, what));
  }

  void Check(const XmlTag& tag) {
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
    if (HasControl(tag.text, "\n\r\t")) {
      Fail(tag.line, fmt::format("<{}>: a control character is in it: {}", tag.element, tag.text));
    }
    if (open_.empty() && has_outermost_) {
      Fail(tag.line, fmt::format("<{}> stands after the outermost element, of which XML has one",
                                 tag.element));
    }
    has_outermost_ = true;
    CheckAttributes(tag);
    RefuseXacro(tag);
    if (tag.element.ends_with(":include")) {
      Fail(tag.line, fmt::format("<{}> is not followed; include the file first: "
                                 "xmllint --xinclude {} > {}",
                                 tag.element, origin_, ExpandedName()));
    }
    if (!tag.empty) open_.push_back(tag);
  }

  void CheckAttributes(const XmlTag& tag) const {
    const std::string_view bad = NoAttribute(tag);
    if (!bad.empty()) {
      Fail(tag.line, fmt::format("{}<{}>: expected NAME=\"VALUE\" after a space, found: {}",
                                 Place(), tag.element, bad.substr(0, bad.find('\n'))));
    }
    std::set<std::string_view> names;
    for (const XmlAttribute& attribute : tag.Attributes()) {
      const std::string_view value = attribute.value;
      if (attribute.name == "name" && (FindNameFault(value) || value.find("&#") != value.npos)) {
        Fail(tag.line, fmt::format("{}<{}>: the name '{}' must be one line without tabs, other "
                                   "control characters and references to characters (&#...;)",
                                   Place(), tag.element, value));
      }
      if (names.insert(attribute.name).second) continue;
      Fail(tag.line,
           fmt::format("{}<{}>: has the attribute {} twice", Place(), tag.element, attribute.name));
    }
  }

  // Prefixes hold to the end of the text: what they are bound to elsewhere is xacro too.
  void NotePrefixes(const std::vector<XmlAttribute>& attributes) {
    for (const XmlAttribute& attribute : attributes) {
      if (!attribute.name.starts_with("xmlns:") || !NamesXacro(attribute.value)) continue;
      xacro_prefixes_.insert(attribute.name.substr(std::string_view("xmlns:").size()));
    }
  }

  bool IsXacro(const XmlTag& tag, const std::vector<XmlAttribute>& attributes) const {
    if (xacro_prefixes_.contains(PrefixOf(tag.element))) return true;
    if (open_.empty()) return false;
    // Without a prefix. All of the outermost element would be in its namespace.
    for (const XmlAttribute& attribute : attributes) {
      if (attribute.name == "xmlns" && NamesXacro(attribute.value)) return true;
    }
    // Xacro of before it had a namespace.
    return open_.size() == 1 && (tag.element == "include" || tag.element == "macro" ||
                                 tag.element == "property" || tag.element == "insert_block");
  }

  void RefuseXacro(const XmlTag& tag) {
    const std::vector<XmlAttribute> attributes = tag.Attributes();
    NotePrefixes(attributes);
    const auto attribute = std::ranges::find_if(attributes, [&](const XmlAttribute& a) {
      return xacro_prefixes_.contains(PrefixOf(a.name));
    });
    std::string what;
    if (IsXacro(tag, attributes)) {
      what = fmt::format("<{}> is xacro and not expanded", tag.element);
    } else if (attribute != attributes.end()) {
      what = fmt::format("{}<{}>: the attribute {} is xacro and not expanded", Place(), tag.element,
                         attribute->name);
    } else if (IsDescription(tag)) {
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
         fmt::format("{}; expand the file first: xacro {} > {}", what, origin_, ExpandedName()));
  }

  // Whether a URDF or an SRDF says something there: other tools' elements may hold anything.
  bool IsDescription(const XmlTag& tag) const {
    static const std::set<std::string_view> kSaying = {"link",
                                                       "joint",
                                                       "group",
                                                       "group_state",
                                                       "end_effector",
                                                       "virtual_joint",
                                                       "passive_joint",
                                                       "disable_collisions",
                                                       "enable_collisions",
                                                       "disable_default_collisions",
                                                       "link_sphere_approximation"};
    return open_.empty() || kSaying.contains(open_.size() > 1 ? open_[1].element : tag.element);
  }

  // arm.srdf.xacro becomes arm.srdf; a name that does not say what it is of, expanded.
  std::string ExpandedName() const {
    std::filesystem::path name = origin_;
    if (name.extension() == ".xacro") name.replace_extension();
    if (name != origin_ && name.has_extension()) return name.string();
    return "expanded" + (name.has_extension() ? name.extension().string() : ".xml");
  }

  bool Within(std::string_view element) const {
    return open_.size() > 1 && open_[1].element == element;
  }

  // "link 'name': " inside a link or joint.
  std::string Place() const {
    if (!Within("link") && !Within("joint")) return "";
    return fmt::format("{} '{}': ", open_[1].element, open_[1].Attribute("name").value_or(""));
  }

  const std::string& origin_;
  std::vector<XmlTag> open_;
  bool has_outermost_ = false;
  std::set<std::string_view> xacro_prefixes_ = {"xacro"};
};

// The first of `any` from `at` on that is not between quotes; the text's end if there is none.
std::size_t FindUnquoted(std::string_view text, std::size_t at, std::string_view any) {
  for (char quote = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (any.find(c) != std::string_view::npos) {
      break;
    }
  }
  return at;
}

// Behind what begins at `at` with `begin`, a comment or the like, and ends with `end`.
std::size_t EndOf(std::string_view text, std::size_t at, std::string_view begin,
                  std::string_view end) {
  const std::size_t found = text.find(end, at + begin.size());
  return found == std::string_view::npos ? text.size() : found + end.size();
}

// Refuses text before the outermost element, for which parsers take the document for empty, and
// definitions: parsers read a declaration up to the first '>', which ends the first of them.
void CheckProlog(std::string_view text, const std::string& origin) {
  const auto fail = [&](std::size_t at, const std::string& what) {
    throw InputError(
        fmt::format("{}:{}: {}", origin, 1 + std::ranges::count(text.substr(0, at), '\n'), what));
  };
  std::size_t end = text.starts_with("\xef\xbb\xbf") ? 3 : 0;  // Of what has been read.
  for (std::size_t at = text.find('<'); at < text.size(); at = text.find('<', end)) {
    const std::size_t stray = text.find_first_not_of(" \t\r\n", end);
    if (stray < at) {
      const std::string_view line = text.substr(stray, text.find_first_of("\r\n<", stray) - stray);
      fail(stray,
           fmt::format("text stands before the first element: '{}'", Abridged(Escaped(line), 100)));
    }
    const std::string_view rest = text.substr(at);
    if (rest.starts_with("<!--")) {
      end = EndOf(text, at, "<!--", "-->");
    } else if (rest.starts_with("<?")) {
      end = EndOf(text, at, "<?", "?>");
    } else if (rest.starts_with("<!DOCTYPE")) {
      const std::size_t length = FindUnquoted(rest, 0, "[>");
      if (length == rest.size()) return;
      if (rest[length] == '[') {
        fail(at,
             "<!DOCTYPE> holds definitions ([...]), which are not read; write their values where "
             "they are used, and leave them out");
      }
      end = at + length + 1;
    } else {
      return;
    }
  }
}

// Parsers give names so, and what is noted by a name must be found by theirs.
std::string WithoutEntities(std::string_view value) {
  static constexpr std::pair<std::string_view, char> kEntities[] = {
      {"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}};
  std::string text;
  while (!value.empty()) {
    const auto* const entity = std::ranges::find_if(
        kEntities, [&](const auto& known) { return value.starts_with(known.first); });
    const bool is_one = entity != std::end(kEntities);
    text += is_one ? entity->second : value.front();
    value.remove_prefix(is_one ? entity->first.size() : 1);
  }
  return text;
}

}  // namespace

std::vector<XmlAttribute> XmlTag::Attributes() const {
  constexpr std::string_view kSpace = " \t\r\n";
  std::vector<XmlAttribute> attributes;
  std::string_view rest = text;
  const auto skip = [&](std::size_t end) { rest.remove_prefix(std::min(end, rest.size())); };
  skip(rest.find_first_of(kSpace));
  while (true) {
    skip(rest.find_first_not_of(kSpace));
    const std::string_view name = rest.substr(0, rest.find_first_of(" \t\r\n=\"'/"));
    skip(name.size());
    skip(rest.find_first_not_of(kSpace));
    if (name.empty() || !rest.starts_with('=')) return attributes;
    skip(1);
    skip(rest.find_first_not_of(kSpace));
    if (!rest.starts_with('"') && !rest.starts_with('\'')) return attributes;
    const std::size_t end = rest.find(rest.front(), 1);
    if (end == std::string_view::npos) return attributes;
    attributes.push_back({name, rest.substr(1, end - 1)});
    skip(end + 1);
  }
}

std::optional<std::string> XmlTag::Attribute(std::string_view name) const {
  for (const XmlAttribute& attribute : Attributes()) {
    if (attribute.name == name) return WithoutEntities(attribute.value);
  }
  return std::nullopt;
}

std::optional<XmlTag> XmlTagReader::Next() {
  while (true) {
    at_ = text_.find('<', at_);
    if (at_ == std::string_view::npos) return std::nullopt;
    line_ += static_cast<int>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(counted_),
                                         text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n'));
    counted_ = at_;
    const std::string_view rest = text_.substr(at_);
    if (rest.starts_with("<!--")) {
      at_ = EndOf(text_, at_, "<!--", "-->");
    } else if (rest.starts_with("<![CDATA[")) {
      at_ = EndOf(text_, at_, "<![CDATA[", "]]>");
    } else if (rest.starts_with("<?")) {
      at_ = EndOf(text_, at_, "<?", "?>");
    } else if (rest.starts_with("<!")) {
      at_ = EndOf(text_, at_, "<!", ">");
    } else {
      return Read();
    }
  }
}

XmlTag XmlTagReader::Read() {
  const std::size_t end = FindUnquoted(text_, at_, ">");
  XmlTag tag;
  tag.text = text_.substr(at_, end - at_);
  tag.line = line_;
  tag.closing = tag.text.starts_with("</");
  tag.empty = tag.text.ends_with('/');
  const std::string_view name = tag.text.substr(tag.closing ? 2 : 1);
  tag.element = name.substr(0, name.find_first_of(" \t\r\n/"));
  at_ = end;
  return tag;
}

std::optional<std::vector<double>> ReadNumbers(std::string_view value) {
  std::string line(value);
  std::ranges::replace_if(
      line, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  std::string_view rest = line;
  std::vector<double> numbers;
  for (std::string_view word = TakeWord(&rest); !word.empty(); word = TakeWord(&rest)) {
    const std::optional<double> number = ParseNumber(word);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

void CheckXmlText(std::string_view text, const std::string& origin) {
  RefuseUtf16(text, origin);
  CheckProlog(text, origin);
  const TagChecker checked(text, origin);
}

}  // namespace planbench
