#include "common/yaml.h"

#include <fmt/format.h>
#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <set>

#include "common/error.h"
#include "common/read_text.h"
#include "common/text.h"

namespace planbench {
namespace {

// The last element of a list that `ros2 topic echo` has not printed to its end.
constexpr std::string_view kCut = "...";

using Node = YamlTree::Node;
using Kind = YamlTree::Kind;

bool IsNullNode(const Node& node) { return node.kind == Kind::kNull || node.tag == "!!null"; }

/// The control characters that texts may hold.
constexpr std::string_view kLineBreaks = "\n\t";

bool IsMergeKey(const Node& key) {
  // In quotes it is a key like any other.
  return key.kind == Kind::kScalar && key.text == "<<" && !key.is_quoted;
}

// A map and all that it merges, at any depth, in the order of their word on a key. Each is told
// once, however often it is merged: there may be exponentially many ways to it.
class MergeOrder {
 public:
  explicit MergeOrder(const Node& map) : open_{&map} {}

  /// Null after the last.
  const Node* Next() {
    while (!open_.empty()) {
      const Node* map = open_.back();
      open_.pop_back();
      if (!told_.insert(map).second) continue;
      std::vector<const Node*> merged;
      for (const auto& [key, value] : map->entries) {
        if (!IsMergeKey(*key)) continue;
        if (value->kind == Kind::kMap) {
          merged.push_back(value);
        } else {
          merged.insert(merged.end(), value->elements.begin(), value->elements.end());
        }
      }
      open_.insert(open_.end(), merged.rbegin(), merged.rend());
      return map;
    }
    return nullptr;
  }

 private:
  std::vector<const Node*> open_;  // What comes next is last.
  std::set<const Node*> told_;
};

std::string KindOf(const Node& node) {
  constexpr std::size_t kLongest = 60;
  if (IsNullNode(node)) return "nothing";
  if (node.kind == Kind::kSequence) return "a sequence";
  if (node.kind == Kind::kMap) return "a map";
  return node.text.size() <= kLongest
             ? "'" + node.text + "'"
             : "a text of " + std::to_string(node.text.size()) + " characters";
}

// from_chars and not yaml-cpp's streams: independent of the locale, and "010" is ten.
template <typename Number>
std::errc ReadNumber(std::string_view text, Number* value) {
  const char* begin = text.data();
  const char* const end = begin + text.size();
  if (end - begin > 1 && *begin == '+' && begin[1] != '-') ++begin;
  const auto [stop, error] = std::from_chars(begin, end, *value);
  return stop == end ? error : std::errc::invalid_argument;
}

template <typename Number>
bool ParseNumber(std::string_view text, Number* value) {
  return ReadNumber(text, value) == std::errc();
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

int LineOf(std::string_view text, std::size_t offset) {
  return 1 +
         static_cast<int>(std::count(text.begin(), text.begin() + static_cast<long>(offset), '\n'));
}

}  // namespace

YamlNode YamlNode::LoadFile(const std::string& path) { return Parse(ReadText(path), path); }

YamlNode YamlNode::Parse(const std::string& text, const std::string& origin) {
  RefuseUtf16(text, origin);
  if (const auto zero = text.find('\0'); zero != text.npos) {
    throw InputError(
        fmt::format("{}:{}: a byte is 0; the file must be UTF-8 text", origin, LineOf(text, zero)));
  }
  if (const auto bad = FindInvalidUtf8(text)) {
    throw InputError(origin + ":" + std::to_string(LineOf(text, *bad)) + ": the byte " +
                     text.substr(*bad, 1) + " is no UTF-8; the file must be UTF-8 text");
  }
  std::shared_ptr<Document> document;
  try {
    document = std::make_shared<Document>(text, origin);
  } catch (const YAML::Exception& error) {
    // Of what lacks its end, the last line.
    const int last = LineOf(text, std::min(text.find_last_not_of(" \t\r\n"), text.size()));
    const std::string line =
        error.mark.is_null() ? "" : fmt::format(":{}", std::min(error.mark.line + 1, last));
    // Its own text for this is "bad file".
    const bool is_deep = dynamic_cast<const YAML::DeepRecursion*>(&error) != nullptr;
    throw InputError(origin + line +
                     (is_deep ? ": is nested too deep" : ": no valid YAML: " + error.msg));
  }
  std::vector<const Node*> documents = document->tree.documents();
  std::erase_if(documents, [](const Node* root) { return root->kind == Kind::kNull; });
  if (documents.size() > 1) {
    throw InputError(origin + ":" + std::to_string(documents[1]->line) +
                     ": a second YAML document begins here; one is expected");
  }
  static const Node kNothing;
  YamlNode root(documents.empty() ? &kNothing : documents[0], document, "");
  std::vector<const Node*> ancestors;
  int position = -1;
  root.CheckTree(&ancestors, &position);
  return root;
}

void YamlNode::CheckTree(std::vector<const Node*>* ancestors, int* last_position) const {
  constexpr std::size_t kDeepest = 200;
  // What stands before its parent or its elder sibling is an alias: checked at its anchor.
  if (node_->position <= *last_position &&
      std::ranges::find(*ancestors, node_) != ancestors->end()) {
    Fail("contains itself");
  }
  if (node_->position < *last_position) return;
  *last_position = node_->position;
  if (ancestors->size() > kDeepest) Fail("is nested too deep");
  const std::string& tag = node_->tag;
  const auto require = [&](std::initializer_list<std::string_view> known) {
    if (tag.empty() || std::find(known.begin(), known.end(), tag) != known.end()) return;
    const bool is_angle = tag == "!degrees" || tag == "!radians";
    Fail(fmt::format("the tag '{}' is {}", tag,
                     is_angle ? "one number's; write it before each" : "not known here"));
  };
  if (node_->kind == Kind::kSequence) {
    require({"!!seq"});
    ancestors->push_back(node_);
    int index = 0;
    for (const Node* element : node_->elements) {
      Child(element, path_ + "[" + std::to_string(index++) + "]")
          .CheckTree(ancestors, last_position);
    }
    ancestors->pop_back();
  } else if (node_->kind == Kind::kMap) {
    require({"!!map"});
    ancestors->push_back(node_);
    for (const auto& [key, value] : node_->entries) {
      const std::string path = key->kind == Kind::kScalar ? PathOf(key->text) : path_;
      Child(key, path).CheckTree(ancestors, last_position);
      const YamlNode child = Child(value, path);
      if (IsMergeKey(*key)) child.CheckMerge(*value);
      child.CheckTree(ancestors, last_position);
    }
    ancestors->pop_back();
  } else {
    require({"!!str", "!!int", "!!float", "!!bool", "!!null", "!!binary", "!!merge", "!degrees",
             "!radians"});
  }
}

void YamlNode::CheckMerge(const Node& value) const {
  const auto require_map = [&](const Node& map) {
    if (map.kind != Kind::kMap) {
      Fail("'<<' merges a map or a sequence of maps, found " + KindOf(map));
    }
  };
  if (value.kind != Kind::kSequence) return require_map(value);
  for (const Node* element : value.elements) require_map(*element);
}

void YamlNode::RequireTag(std::initializer_list<std::string_view> allowed,
                          const char* wanted) const {
  const std::string& tag = node_->tag;
  if (tag.empty() || std::find(allowed.begin(), allowed.end(), tag) != allowed.end()) return;
  Fail(std::string("expected ") + wanted + ", found the tag '" + tag + "'");
}

std::shared_ptr<YamlNode> YamlNode::Foreign(const std::string& key, const std::string& text,
                                            const std::string& origin) const {
  auto foreign = std::make_shared<YamlNode>(Parse(text, origin));
  foreign->document_->has_lines = false;
  foreign->path_ = PathOf(key);
  return foreign;
}

bool YamlNode::IsNull() const { return overrides_.empty() && IsNullNode(*node_); }

bool YamlNode::IsBinary() const { return IsScalar() && node_->tag == "!!binary"; }

std::string YamlNode::Where() const {
  std::string where = document_->origin;
  if (document_->has_lines && node_->line > 0) where += ":" + std::to_string(node_->line);
  if (const std::size_t told = document_->num_told; told > 0) return where + path_.substr(told);
  if (!path_.empty()) where += ": " + path_;
  return where;
}

void YamlNode::Fail(const std::string& what) const { throw InputError(Where() + ": " + what); }

void YamlNode::Warn(const std::string& what) const {
  const std::string warning = Printable(Where() + ": " + what);
  if (document_->warned.insert(warning).second) document_->warnings.push_back(warning);
}

const Node* YamlNode::FindIn(const Node& map, const std::string& key) const {
  bool merges = false;
  const auto find_own = [&](const Node& own) {
    const Node* found = nullptr;
    for (const auto& [own_key, value] : own.entries) {
      if (IsMergeKey(*own_key)) {
        merges = true;
        continue;
      }
      if (own_key->kind != Kind::kScalar || own_key->text != key) continue;
      if (found != nullptr) {
        Child(own_key, PathOf(key)).Fail("the key '" + key + "' occurs twice");
      }
      found = value;
    }
    return found;
  };
  if (const Node* value = find_own(map)) return value;
  if (!merges) return nullptr;  // As in nearly all maps, which are looked into often.
  MergeOrder maps(map);
  maps.Next();  // The map itself.
  while (const Node* next = maps.Next()) {
    if (const Node* value = find_own(*next)) return value;
  }
  return nullptr;
}

std::optional<YamlNode> YamlNode::Find(const std::string& key) const {
  if (const auto found = overrides_.find(key); found != overrides_.end()) {
    if (found->second->IsNull()) return std::nullopt;
    return *found->second;
  }
  if (IsNullNode(*node_)) return std::nullopt;
  if (node_->kind != Kind::kMap) Fail("expected a map, found " + KindOf(*node_));
  const Node* value = FindIn(*node_, key);
  if (value == nullptr || IsNullNode(*value)) return std::nullopt;
  return Child(value, PathOf(key));
}

YamlNode YamlNode::At(const std::string& key) const {
  if (!IsMap()) Fail("expected a map with the field '" + key + "', found " + KindOf(*node_));
  std::optional<YamlNode> value = Find(key);
  if (value) return *std::move(value);
  if (const auto own = overrides_.find(key); own != overrides_.end()) {
    own->second->Fail("the field '" + key + "' has no value");
  }
  if (const Node* null = FindIn(*node_, key); null != nullptr) {
    Child(null, PathOf(key)).Fail("the field '" + key + "' has no value");
  }
  Fail("the field '" + key + "' is missing");
}

std::vector<std::pair<const Node*, const Node*>> YamlNode::Entries(const Node& map) const {
  std::vector<std::pair<const Node*, const Node*>> entries;
  std::set<std::string> said;  // By this map and those before.
  MergeOrder maps(map);
  while (const Node* next = maps.Next()) {
    std::set<std::string> own;
    for (const auto& [key, value] : next->entries) {
      if (key->kind != Kind::kScalar) Child(key, path_).Fail("a key is not plain text");
      const std::string& name = key->text;
      if (HasControl(name, kLineBreaks)) Child(key, path_).Fail("a control character is in a key");
      if (!own.insert(name).second) {
        Child(key, PathOf(name)).Fail("the key '" + name + "' occurs twice");
      }
      if (IsMergeKey(*key) || !said.insert(name).second) continue;
      entries.emplace_back(key, value);
    }
  }
  return entries;
}

std::vector<std::string> YamlNode::Keys() const {
  std::vector<std::string> keys;
  if (!IsNullNode(*node_)) {
    if (node_->kind != Kind::kMap) Fail("expected a map, found " + KindOf(*node_));
    for (const auto& [key, value] : Entries(*node_)) keys.push_back(key->text);
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
  if (!IsNullNode(*node_)) {
    if (node_->kind != Kind::kMap) Fail("expected a map, found " + KindOf(*node_));
    for (const auto& [key, value] : Entries(*node_)) {
      require(key->text, Child(key, PathOf(key->text)));
    }
  }
  for (const auto& [key, replacement] : overrides_) require(key, *replacement);
}

void YamlNode::AllowOnly(std::initializer_list<std::string_view> known) const {
  RequireKeys([&](const std::string& key) -> std::optional<std::string> {
    const auto accepts = [&](std::string_view name) {
      return name.ends_with('*') ? key.starts_with(name.substr(0, name.size() - 1)) : key == name;
    };
    if (std::any_of(known.begin(), known.end(), accepts)) return std::nullopt;
    const std::string nearest = NearestName(key, {known.begin(), known.end()});
    return fmt::format("unknown key '{}'; {}known are: {}", key,
                       nearest.empty() ? "" : fmt::format("did you mean '{}'? ", nearest),
                       fmt::join(known, ", "));
  });
}

void YamlNode::RequireValues() const {
  for (const std::string& key : Keys()) At(key);
}

void YamlNode::RequirePrinted() const {
  if (node_->kind != Kind::kScalar || !node_->text.ends_with('>')) return;
  for (const char* beginning : {"<array type: ", "<sequence type: ", "<string length: "}) {
    if (!node_->text.starts_with(beginning)) continue;
    Fail("was left out of the dump, which says " + KindOf(*node_) +
         "; use 'topic echo' without --noarr, --no-arr, --nostr and --no-str");
  }
}

int YamlNode::Size() const {
  RequirePrinted();
  if (!IsSequence()) Fail("expected a sequence, found " + KindOf(*node_));
  return static_cast<int>(node_->elements.size());
}

YamlNode YamlNode::At(int index) const {
  if (index < 0 || index >= Size()) Fail("element " + std::to_string(index) + " is missing");
  return Child(node_->elements[static_cast<std::size_t>(index)],
               path_ + "[" + std::to_string(index) + "]");
}

std::vector<YamlNode> YamlNode::Elements() const {
  const int size = Size();
  std::vector<YamlNode> elements;
  elements.reserve(static_cast<std::size_t>(size));
  for (int index = 0; index < size; ++index) {
    const Node* element = node_->elements[static_cast<std::size_t>(index)];
    elements.push_back(Child(element, path_ + "[" + std::to_string(index) + "]"));
    if (element->kind == Kind::kScalar && element->text == kCut) {
      elements.back().Fail("the list was cut here by 'ros2 topic echo'; use --full-length");
    }
  }
  return elements;
}

double YamlNode::Double() const {
  double value = 0;
  if (!IsScalar()) Fail("expected a number, found " + KindOf(*node_));
  RequireTag({"!!str", "!!int", "!!float", "!degrees", "!radians"}, "a number");
  const bool parsed = ParseDouble(node_->text, node_->tag, &value);
  if (parsed && std::isfinite(value)) return value;
  if (ReadNumber(node_->text, &value) == std::errc::result_out_of_range) {
    Fail(KindOf(*node_) +
         " cannot be represented: it is nearer to 0 than 5e-324, or beyond 1.797e308");
  }
  const bool non_finite =
      parsed ||
      (YAML::convert<double>::decode(YAML::Node(node_->text), value) && !std::isfinite(value));
  const bool is_in_radians = node_->tag == "!radians" || Argument(node_->text, "rad").has_value();
  Fail(fmt::format("expected a {}number{}, found {}", non_finite ? "finite " : "",
                   is_in_radians ? " or a product or quotient of such and pi" : "",
                   KindOf(*node_)));
}

double YamlNode::PositiveDouble() const {
  const double value = Double();
  if (value <= 0) Fail("must be greater than zero, found " + KindOf(*node_));
  return value;
}

double YamlNode::NonNegativeDouble() const {
  const double value = Double();
  if (value < 0) Fail("must not be negative, found " + KindOf(*node_));
  return value;
}

double YamlNode::DoubleWithin(double least, double most) const {
  const double value = Double();
  if (value < least || value > most) {
    Fail(fmt::format("must be from {} to {}, found {}", least, most, value));
  }
  return value;
}

long long YamlNode::Int() const {
  long long value = 0;
  if (!IsScalar()) Fail("expected an integer, found " + KindOf(*node_));
  RequireTag({"!!str", "!!int"}, "an integer");
  const std::errc error = ReadNumber(node_->text, &value);
  if (error == std::errc::result_out_of_range) {
    Fail(KindOf(*node_) + " cannot be represented: integers have 64 bits");
  }
  if (error != std::errc()) Fail("expected an integer, found " + KindOf(*node_));
  return value;
}

int YamlNode::IntWithin(int least, int most) const {
  const long long value = Int();
  if (value < least || value > most) {
    Fail(fmt::format("must be from {} to {}, found {}", least, most, value));
  }
  return static_cast<int>(value);
}

bool YamlNode::Bool() const {
  bool value = false;
  if (!IsScalar()) Fail("expected true or false, found " + KindOf(*node_));
  RequireTag({"!!str", "!!bool"}, "true or false");
  if (!YAML::convert<bool>::decode(YAML::Node(node_->text), value)) {
    Fail("expected true or false, found " + KindOf(*node_));
  }
  return value;
}

std::string YamlNode::String() const {
  if (!IsScalar()) Fail("expected text, found " + KindOf(*node_));
  RequirePrinted();
  RequireTag({"!!str", "!!int", "!!float", "!!bool"}, "text");
  if (HasControl(node_->text, kLineBreaks)) Fail("a control character is in " + KindOf(*node_));
  return node_->text;
}

std::optional<int> YamlNode::RawByte() const {
  if (!IsScalar()) return std::nullopt;
  const bool is_binary = IsBinary();
  const std::string text = is_binary ? "" : node_->text;
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
    std::vector<std::uint8_t> bytes = YAML::DecodeBase64(node_->text);
    if (bytes.empty() && !Trimmed(node_->text).empty()) Fail("is no base64");
    return bytes;
  }
  RequirePrinted();
  if (!IsSequence()) Fail("expected a sequence of bytes or !!binary, found " + KindOf(*node_));
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
  if (!IsNullNode(*node_) && node_->kind != Kind::kMap) {
    throw InputError(origin + ": " + Where() + ": expected a map, found " + KindOf(*node_));
  }
  const std::size_t dot = key.find('.');
  const bool is_own =
      overrides_.contains(key) || (!IsNullNode(*node_) && FindIn(*node_, key) != nullptr);
  if (dot == std::string::npos || is_own) {
    const std::shared_ptr<YamlNode> value = Foreign(key, text, origin);
    value->document_->num_told = value->path_.size();
    overrides_[key] = value;
    return;
  }
  const std::string outer = key.substr(0, dot);
  const std::optional<YamlNode> found = Find(outer);
  const auto map = found ? std::make_shared<YamlNode>(*found) : Foreign(outer, "{}", origin);
  map->Override(key.substr(dot + 1), text, origin);
  overrides_[outer] = map;
}

}  // namespace planbench
