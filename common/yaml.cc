#include "common/yaml.h"

#include <fmt/format.h>
#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <numbers>
#include <set>
#include <sstream>

#include "common/error.h"
#include "common/text.h"

namespace planbench {
namespace {

// The last element of a list that `ros2 topic echo` has not printed to its end.
constexpr std::string_view kCut = "...";

// The tag of a node in its short form, "" for none. yaml-cpp gives "?" to what is plain and "!" to
// what is quoted.
std::string ShortTag(const YAML::Node& node) {
  constexpr std::string_view kYaml = "tag:yaml.org,2002:";
  const std::string& tag = node.Tag();
  if (tag == "?" || tag == "!") return "";
  return tag.starts_with(kYaml) ? "!!" + tag.substr(kYaml.size()) : tag;
}

bool IsNullNode(const YAML::Node& node) { return node.IsNull() || ShortTag(node) == "!!null"; }

/// The control characters that texts may hold.
constexpr std::string_view kLineBreaks = "\n\t";

bool IsMergeKey(const YAML::Node& key) {
  // In quotes it is a key like any other.
  return key.IsScalar() && key.Scalar() == "<<" && key.Tag() != "!";
}

// A map and all that it merges, at any depth, in the order of their word on a key. Each is told
// once, however often it is merged: there may be exponentially many ways to it.
class MergeOrder {
 public:
  explicit MergeOrder(const YAML::Node& map) : open_{map} {}

  /// Nothing after the last.
  std::optional<YAML::Node> Next() {
    while (!open_.empty()) {
      const YAML::Node map = open_.back();
      open_.pop_back();
      // No two maps of a document begin at the same place, but for one that is a key.
      if (!told_.insert(map.Mark().pos).second) continue;
      std::vector<YAML::Node> merged;
      for (const auto& entry : map) {
        if (!IsMergeKey(entry.first)) continue;
        if (entry.second.IsMap()) {
          merged.push_back(entry.second);
        } else {
          for (const auto& element : entry.second) merged.push_back(element);
        }
      }
      for (auto other = merged.rbegin(); other != merged.rend(); ++other) open_.push_back(*other);
      return map;
    }
    return std::nullopt;
  }

 private:
  std::vector<YAML::Node> open_;  // What comes next is last.
  std::set<int> told_;            // By their positions in the text.
};

std::string KindOf(const YAML::Node& node) {
  constexpr std::size_t kLongest = 60;
  if (IsNullNode(node)) return "nothing";
  switch (node.Type()) {
    case YAML::NodeType::Scalar: {
      const std::string& text = node.Scalar();
      return text.size() <= kLongest ? "'" + text + "'"
                                     : "a text of " + std::to_string(text.size()) + " characters";
    }
    case YAML::NodeType::Sequence:
      return "a sequence";
    case YAML::NodeType::Map:
      return "a map";
    default:
      return "an undefined value";
  }
}

// from_chars and not yaml-cpp's streams: independent of the locale, and "010" is ten.
template <typename Number>
bool ParseNumber(std::string_view text, Number* value) {
  const char* begin = text.data();
  const char* const end = begin + text.size();
  if (end - begin > 1 && *begin == '+' && begin[1] != '-') ++begin;
  const auto [stop, error] = std::from_chars(begin, end, *value);
  return error == std::errc() && stop == end;
}

std::string_view Trimmed(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

// A product and quotient of numbers and pi, as rosparam's !radians has it: "pi/2", "-1.5*pi".
bool ParseRadians(std::string_view text, double* value) {
  *value = 1;
  bool divide = false;
  while (true) {
    const std::size_t end = std::min(text.find_first_of("*/"), text.size());
    std::string_view factor = Trimmed(text.substr(0, end));
    const bool negative = factor == "-pi";
    if (negative || factor == "+pi") factor.remove_prefix(1);
    double number = std::numbers::pi;
    if (factor != "pi" && !ParseNumber(factor, &number)) return false;
    if (negative) number = -number;
    *value = divide ? *value / number : *value * number;
    if (end == text.size()) return true;
    divide = text[end] == '/';
    text.remove_prefix(end + 1);
  }
}

// The content of "FUNCTION(content)", nothing for other texts.
std::optional<std::string_view> Argument(std::string_view text, std::string_view function) {
  if (!text.starts_with(function) || !text.ends_with(')')) return std::nullopt;
  text.remove_prefix(function.size());
  text.remove_suffix(1);
  if (!text.starts_with('(')) return std::nullopt;
  return Trimmed(text.substr(1));
}

// A number, or an angle in one of rosparam's forms, in rad.
bool ParseDouble(std::string_view text, std::string_view tag, double* value) {
  if (const auto degrees = Argument(text, "deg"); degrees || tag == "!degrees") {
    if (tag == "!radians" || !ParseNumber(degrees.value_or(text), value)) return false;
    *value *= std::numbers::pi / 180;
    return true;
  }
  if (const auto radians = Argument(text, "rad"); radians || tag == "!radians") {
    return ParseRadians(radians.value_or(text), value);
  }
  return ParseNumber(text, value);
}

// Where a document begins.
class DocumentStart : public YAML::EventHandler {
 public:
  YAML::Mark mark;

  void OnDocumentStart(const YAML::Mark& start) override { mark = start; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
};

// yaml-cpp 0.7 reads documents without end where a bracket closes that none has opened.
void RequireDocumentsThatEnd(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  DocumentStart document;
  for (int last = -1; parser.HandleNextDocument(document); last = document.mark.pos) {
    if (document.mark.pos == last) {
      throw YAML::ParserException(document.mark, "nothing is open that could end here");
    }
  }
}

int LineOf(std::string_view text, std::size_t offset) {
  return 1 +
         static_cast<int>(std::count(text.begin(), text.begin() + static_cast<long>(offset), '\n'));
}

}  // namespace

YamlNode YamlNode::LoadFile(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw InputError(path + ": cannot be opened");
  std::ostringstream text;
  if (file.peek() != std::ifstream::traits_type::eof()) text << file.rdbuf();
  if (file.bad() || !text) throw InputError(path + ": cannot be read");
  return Parse(text.str(), path);
}

YamlNode YamlNode::Parse(const std::string& text, const std::string& origin) {
  if (const auto bad = FindInvalidUtf8(text)) {
    throw InputError(origin + ":" + std::to_string(LineOf(text, *bad)) + ": the byte " +
                     text.substr(*bad, 1) + " is no UTF-8; the file must be UTF-8 text");
  }
  std::vector<YAML::Node> documents;
  try {
    RequireDocumentsThatEnd(text);
    documents = YAML::LoadAll(text);
  } catch (const YAML::Exception& error) {
    const std::string line = error.mark.is_null() ? "" : ":" + std::to_string(error.mark.line + 1);
    // Its own text for this is "bad file".
    const bool is_deep = dynamic_cast<const YAML::DeepRecursion*>(&error) != nullptr;
    throw InputError(origin + line +
                     (is_deep ? ": is nested too deep" : ": no valid YAML: " + error.msg));
  }
  std::erase_if(documents, [](const YAML::Node& document) { return document.IsNull(); });
  if (documents.size() > 1) {
    throw InputError(origin + ":" + std::to_string(documents[1].Mark().line + 1) +
                     ": a second YAML document begins here; one is expected");
  }
  YamlNode root(documents.empty() ? YAML::Node() : documents[0],
                std::make_shared<Document>(Document{origin, true, {}}), "");
  std::vector<YAML::Node> ancestors;
  int position = -1;
  root.CheckTree(&ancestors, &position);
  return root;
}

void YamlNode::CheckTree(std::vector<YAML::Node>* ancestors, int* last_position) const {
  constexpr std::size_t kDeepest = 200;
  // What stands before its parent or its elder sibling is an alias: checked at its anchor.
  if (node_.Mark().pos < *last_position) return;
  *last_position = node_.Mark().pos;
  if (ancestors->size() > kDeepest) Fail("is nested too deep");
  const std::string tag = ShortTag(node_);
  const auto require = [&](std::initializer_list<std::string_view> known) {
    if (tag.empty() || std::find(known.begin(), known.end(), tag) != known.end()) return;
    const bool is_angle = tag == "!degrees" || tag == "!radians";
    Fail(fmt::format("the tag '{}' is {}", tag,
                     is_angle ? "one number's; write it before each" : "not known here"));
  };
  if (node_.IsSequence()) {
    require({"!!seq"});
    ancestors->push_back(node_);
    int index = 0;
    for (const auto& element : node_) {
      Child(element, path_ + "[" + std::to_string(index++) + "]")
          .CheckTree(ancestors, last_position);
    }
    ancestors->pop_back();
  } else if (node_.IsMap()) {
    require({"!!map"});
    ancestors->push_back(node_);
    for (const auto& entry : node_) {
      const std::string path = entry.first.IsScalar() ? PathOf(entry.first.Scalar()) : path_;
      Child(entry.first, path).CheckTree(ancestors, last_position);
      const YamlNode value = Child(entry.second, path);
      if (IsMergeKey(entry.first)) value.CheckMerge(entry.second, *ancestors);
      value.CheckTree(ancestors, last_position);
    }
    ancestors->pop_back();
  } else {
    require({"!!str", "!!int", "!!float", "!!bool", "!!null", "!!binary", "!!merge", "!degrees",
             "!radians"});
  }
}

void YamlNode::CheckMerge(const YAML::Node& value, const std::vector<YAML::Node>& ancestors) const {
  const auto require_map = [&](const YAML::Node& map) {
    if (!map.IsMap()) Fail("'<<' merges a map or a sequence of maps, found " + KindOf(map));
    for (const YAML::Node& ancestor : ancestors) {
      if (map.is(ancestor)) Fail("'<<' merges a map into itself");
    }
  };
  if (!value.IsSequence()) return require_map(value);
  for (const auto& element : value) require_map(element);
}

void YamlNode::RequireTag(std::initializer_list<std::string_view> allowed,
                          const char* wanted) const {
  const std::string tag = ShortTag(node_);
  if (tag.empty() || std::find(allowed.begin(), allowed.end(), tag) != allowed.end()) return;
  Fail(std::string("expected ") + wanted + ", found the tag '" + tag + "'");
}

YamlNode YamlNode::Foreign(const YAML::Node& node, const std::string& key,
                           const std::string& origin) const {
  return YamlNode(node, std::make_shared<Document>(Document{origin, false, {}}), PathOf(key));
}

bool YamlNode::IsNull() const { return overrides_.empty() && IsNullNode(node_); }

bool YamlNode::IsBinary() const { return IsScalar() && ShortTag(node_) == "!!binary"; }

std::string YamlNode::Where() const {
  std::string where = document_->origin;
  const YAML::Mark mark = node_.Mark();
  if (document_->has_lines && !mark.is_null()) where += ":" + std::to_string(mark.line + 1);
  if (!path_.empty()) where += ": " + path_;
  return where;
}

void YamlNode::Fail(const std::string& what) const { throw InputError(Where() + ": " + what); }

void YamlNode::Warn(const std::string& what) const {
  const std::string warning = Printable(Where() + ": " + what);
  std::vector<std::string>& warnings = document_->warnings;
  if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end()) {
    warnings.push_back(warning);
  }
}

std::optional<YAML::Node> YamlNode::FindIn(const YAML::Node& map, const std::string& key) const {
  bool merges = false;
  // By hand and not by map[key], which keeps silent about a key that occurs twice.
  const auto find_own = [&](const YAML::Node& own) {
    std::optional<YAML::Node> value;
    for (const auto& entry : own) {
      if (IsMergeKey(entry.first)) {
        merges = true;
        continue;
      }
      if (!entry.first.IsScalar() || entry.first.Scalar() != key) continue;
      if (value) Child(entry.first, PathOf(key)).Fail("the key '" + key + "' occurs twice");
      value.emplace(entry.second);
    }
    return value;
  };
  if (const std::optional<YAML::Node> value = find_own(map)) return value;
  if (!merges) return std::nullopt;  // As in nearly all maps, which are looked into often.
  MergeOrder maps(map);
  maps.Next();  // The map itself.
  while (const std::optional<YAML::Node> next = maps.Next()) {
    if (const std::optional<YAML::Node> value = find_own(*next)) return value;
  }
  return std::nullopt;
}

std::optional<YamlNode> YamlNode::Find(const std::string& key) const {
  if (const auto found = overrides_.find(key); found != overrides_.end()) {
    if (found->second->IsNull()) return std::nullopt;
    return *found->second;
  }
  if (IsNullNode(node_)) return std::nullopt;
  if (!node_.IsMap()) Fail("expected a map, found " + KindOf(node_));
  const std::optional<YAML::Node> value = FindIn(node_, key);
  if (!value || IsNullNode(*value)) return std::nullopt;
  return Child(*value, PathOf(key));
}

YamlNode YamlNode::At(const std::string& key) const {
  if (!IsMap()) Fail("expected a map with the field '" + key + "', found " + KindOf(node_));
  std::optional<YamlNode> value = Find(key);
  if (!value) Fail("the field '" + key + "' is missing");
  return *std::move(value);
}

std::vector<YamlNode::Entry> YamlNode::Entries(const YAML::Node& map) const {
  std::vector<Entry> entries;
  std::set<std::string> said;  // By this map and those before.
  MergeOrder maps(map);
  while (const std::optional<YAML::Node> next = maps.Next()) {
    std::set<std::string> own;
    for (const auto& entry : *next) {
      if (!entry.first.IsScalar()) Child(entry.first, path_).Fail("a key is not plain text");
      const std::string& key = entry.first.Scalar();
      if (HasControl(key, kLineBreaks))
        Child(entry.first, path_).Fail("a control character is in a key");
      if (!own.insert(key).second) {
        Child(entry.first, PathOf(key)).Fail("the key '" + key + "' occurs twice");
      }
      if (IsMergeKey(entry.first) || !said.insert(key).second) continue;
      entries.emplace_back(entry.first, entry.second);
    }
  }
  return entries;
}

std::vector<std::string> YamlNode::Keys() const {
  std::vector<std::string> keys;
  if (!IsNullNode(node_)) {
    if (!node_.IsMap()) Fail("expected a map, found " + KindOf(node_));
    for (const Entry& entry : Entries(node_)) keys.push_back(entry.first.Scalar());
  }
  for (const auto& [key, replacement] : overrides_) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  }
  return keys;
}

void YamlNode::RequireKeys(
    const std::function<std::optional<std::string>(const std::string&)>& accepts) const {
  const auto require = [&](const std::string& key, const YamlNode& at) {
    if (const auto complaint = accepts(key)) at.Fail(*complaint);
  };
  if (!IsNullNode(node_)) {
    if (!node_.IsMap()) Fail("expected a map, found " + KindOf(node_));
    for (const Entry& entry : Entries(node_)) {
      const std::string& key = entry.first.Scalar();
      require(key, Child(entry.first, PathOf(key)));
    }
  }
  for (const auto& [key, replacement] : overrides_) require(key, *replacement);
}

void YamlNode::AllowOnly(std::initializer_list<std::string_view> known) const {
  RequireKeys([&](const std::string& key) -> std::optional<std::string> {
    if (std::find(known.begin(), known.end(), key) != known.end()) return std::nullopt;
    const std::string nearest = NearestName(key, {known.begin(), known.end()});
    return fmt::format("unknown key '{}'; {}known are: {}", key,
                       nearest.empty() ? "" : fmt::format("did you mean '{}'? ", nearest),
                       fmt::join(known, ", "));
  });
}

void YamlNode::RequirePrinted() const {
  if (!node_.IsScalar() || !node_.Scalar().ends_with('>')) return;
  for (const char* beginning : {"<array type: ", "<sequence type: ", "<string length: "}) {
    if (!node_.Scalar().starts_with(beginning)) continue;
    Fail("was left out of the dump, which says " + KindOf(node_) +
         "; use 'topic echo' without --noarr, --no-arr, --nostr and --no-str");
  }
}

int YamlNode::Size() const {
  RequirePrinted();
  if (!node_.IsSequence()) Fail("expected a sequence, found " + KindOf(node_));
  return static_cast<int>(node_.size());
}

YamlNode YamlNode::At(int index) const {
  if (index < 0 || index >= Size()) Fail("element " + std::to_string(index) + " is missing");
  return Child(node_[static_cast<std::size_t>(index)], path_ + "[" + std::to_string(index) + "]");
}

std::vector<YamlNode> YamlNode::Elements() const {
  const int size = Size();
  std::vector<YamlNode> elements;
  elements.reserve(static_cast<std::size_t>(size));
  // By iterator: access by index into a yaml-cpp sequence is linear in the index.
  int index = 0;
  for (const auto& element : node_) {
    elements.push_back(Child(element, path_ + "[" + std::to_string(index++) + "]"));
    if (element.IsScalar() && element.Scalar() == kCut) {
      elements.back().Fail("the list was cut here by 'ros2 topic echo'; use --full-length");
    }
  }
  return elements;
}

double YamlNode::Double() const {
  double value = 0;
  if (!IsScalar()) Fail("expected a number, found " + KindOf(node_));
  RequireTag({"!!str", "!!int", "!!float", "!degrees", "!radians"}, "a number");
  const bool parsed = ParseDouble(node_.Scalar(), ShortTag(node_), &value);
  if (parsed && std::isfinite(value)) return value;
  const bool non_finite =
      parsed || (YAML::convert<double>::decode(node_, value) && !std::isfinite(value));
  const bool is_in_radians =
      ShortTag(node_) == "!radians" || Argument(node_.Scalar(), "rad").has_value();
  Fail(fmt::format("expected a {}number{}, found {}", non_finite ? "finite " : "",
                   is_in_radians ? " or a product or quotient of such and pi" : "", KindOf(node_)));
}

double YamlNode::PositiveDouble() const {
  const double value = Double();
  if (value <= 0) Fail("must be greater than zero, found " + KindOf(node_));
  return value;
}

long long YamlNode::Int() const {
  long long value = 0;
  if (!IsScalar()) Fail("expected an integer, found " + KindOf(node_));
  RequireTag({"!!str", "!!int"}, "an integer");
  if (!ParseNumber(node_.Scalar(), &value)) {
    Fail("expected an integer, found " + KindOf(node_));
  }
  return value;
}

bool YamlNode::Bool() const {
  bool value = false;
  if (!IsScalar()) Fail("expected true or false, found " + KindOf(node_));
  RequireTag({"!!str", "!!bool"}, "true or false");
  if (!YAML::convert<bool>::decode(node_, value)) {
    Fail("expected true or false, found " + KindOf(node_));
  }
  return value;
}

std::string YamlNode::String() const {
  if (!IsScalar()) Fail("expected text, found " + KindOf(node_));
  RequirePrinted();
  RequireTag({"!!str", "!!int", "!!float", "!!bool"}, "text");
  if (HasControl(node_.Scalar(), kLineBreaks)) Fail("a control character is in " + KindOf(node_));
  return node_.Scalar();
}

std::optional<int> YamlNode::RawByte() const {
  if (!IsScalar()) return std::nullopt;
  const bool is_binary = IsBinary();
  const std::string text = is_binary ? "" : node_.Scalar();
  const std::vector<std::uint8_t> bytes =
      is_binary ? Bytes() : std::vector<std::uint8_t>(text.begin(), text.end());
  if (bytes.size() != 1 || (!is_binary && bytes[0] >= 0x20)) return std::nullopt;
  return bytes[0];
}

std::vector<double> YamlNode::Doubles() const {
  std::vector<double> values;
  for (const YamlNode& element : Elements()) values.push_back(element.Double());
  return values;
}

std::vector<double> YamlNode::Doubles(int expected_size) const {
  std::vector<double> values;
  const std::vector<YamlNode> elements = Elements();
  if (elements.size() != static_cast<std::size_t>(expected_size)) {
    Fail("expected " + std::to_string(expected_size) + " numbers, found " +
         std::to_string(elements.size()));
  }
  for (const YamlNode& element : elements) values.push_back(element.Double());
  return values;
}

std::vector<std::string> YamlNode::Strings() const {
  std::vector<std::string> values;
  for (const YamlNode& element : Elements()) values.push_back(element.String());
  return values;
}

std::vector<std::uint8_t> YamlNode::Bytes() const {
  if (IsBinary()) {
    std::vector<std::uint8_t> bytes = YAML::DecodeBase64(node_.Scalar());
    if (bytes.empty() && !Trimmed(node_.Scalar()).empty()) Fail("is no base64");
    return bytes;
  }
  RequirePrinted();
  if (!IsSequence()) Fail("expected a sequence of bytes or !!binary, found " + KindOf(node_));
  std::vector<std::uint8_t> bytes;
  for (const YamlNode& element : Elements()) {
    const long long value = element.Int();
    if (value < -128 || value > 255) element.Fail("is no byte: " + std::to_string(value));
    bytes.push_back(static_cast<std::uint8_t>(value));
  }
  return bytes;
}

double YamlNode::DoubleOr(const std::string& key, double fallback) const {
  const std::optional<YamlNode> value = Find(key);
  return value ? value->Double() : fallback;
}

bool YamlNode::BoolOr(const std::string& key, bool fallback) const {
  const std::optional<YamlNode> value = Find(key);
  return value ? value->Bool() : fallback;
}

std::string YamlNode::StringOr(const std::string& key, const std::string& fallback) const {
  const std::optional<YamlNode> value = Find(key);
  return value ? value->String() : fallback;
}

void YamlNode::Override(const std::string& key, const std::string& text,
                        const std::string& origin) {
  if (!IsNullNode(node_) && !node_.IsMap()) {
    throw InputError(origin + ": " + Where() + ": expected a map, found " + KindOf(node_));
  }
  const std::size_t dot = key.find('.');
  const bool is_own =
      overrides_.contains(key) || (!IsNullNode(node_) && FindIn(node_, key).has_value());
  if (dot == std::string::npos || is_own) {
    overrides_[key] = std::make_shared<YamlNode>(Foreign(Parse(text, origin).node_, key, origin));
    return;
  }
  const std::string outer = key.substr(0, dot);
  const std::optional<YamlNode> found = Find(outer);
  YamlNode map = found ? *found : Foreign(YAML::Node(YAML::NodeType::Map), outer, origin);
  map.Override(key.substr(dot + 1), text, origin);
  overrides_[outer] = std::make_shared<YamlNode>(std::move(map));
}

}  // namespace planbench
