#include "common/yaml.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "common/error.h"

namespace planbench {
namespace {

std::string KindOf(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Null:
      return "nothing";
    case YAML::NodeType::Scalar:
      return "'" + node.Scalar() + "'";
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
bool ParseNumber(const std::string& text, Number* value) {
  const char* begin = text.data();
  const char* const end = begin + text.size();
  if (end - begin > 1 && *begin == '+' && begin[1] != '-') ++begin;
  const auto [stop, error] = std::from_chars(begin, end, *value);
  return error == std::errc() && stop == end;
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
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.size() > 1) {
      throw InputError(origin + ":" + std::to_string(documents[1].Mark().line + 1) +
                       ": a second YAML document begins here; one is expected");
    }
    return YamlNode(documents.empty() ? YAML::Node() : documents[0], origin, "", true);
  } catch (const YAML::Exception& error) {
    const std::string line = error.mark.is_null() ? "" : ":" + std::to_string(error.mark.line + 1);
    throw InputError(origin + line + ": no valid YAML: " + error.msg);
  }
}

YamlNode YamlNode::Child(const YAML::Node& node, const std::string& path) const {
  return YamlNode(node, origin_, path, has_lines_);
}

std::string YamlNode::Where() const {
  std::string where = origin_;
  const YAML::Mark mark = node_.Mark();
  if (has_lines_ && !mark.is_null()) where += ":" + std::to_string(mark.line + 1);
  if (!path_.empty()) where += ": " + path_;
  return where;
}

void YamlNode::Fail(const std::string& what) const { throw InputError(Where() + ": " + what); }

std::optional<YamlNode> YamlNode::Find(const std::string& key) const {
  if (const auto found = overrides_.find(key); found != overrides_.end()) {
    if (found->second.node.IsNull()) return std::nullopt;
    return YamlNode(found->second.node, found->second.origin, key, false);
  }
  if (node_.IsNull()) return std::nullopt;
  if (!node_.IsMap()) Fail("expected a map, found " + KindOf(node_));
  const std::string path = path_.empty() ? key : path_ + "." + key;
  std::optional<YamlNode> value;
  // By hand and not by node_[key], which keeps silent about a key that occurs twice.
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar() || entry.first.Scalar() != key) continue;
    if (value) Child(entry.first, path).Fail("the key '" + key + "' occurs twice");
    value = Child(entry.second, path);
  }
  if (!value || value->node_.IsNull()) return std::nullopt;
  return value;
}

YamlNode YamlNode::At(const std::string& key) const {
  if (!IsMap()) Fail("expected a map with the field '" + key + "', found " + KindOf(node_));
  std::optional<YamlNode> value = Find(key);
  if (!value) Fail("the field '" + key + "' is missing");
  return *std::move(value);
}

std::vector<std::string> YamlNode::Keys() const {
  std::vector<std::string> keys;
  if (!node_.IsNull()) {
    if (!node_.IsMap()) Fail("expected a map, found " + KindOf(node_));
    for (const auto& entry : node_) {
      if (!entry.first.IsScalar()) Child(entry.first, path_).Fail("a key is not plain text");
      keys.push_back(entry.first.Scalar());
    }
  }
  for (const auto& [key, replacement] : overrides_) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  }
  return keys;
}

void YamlNode::AllowOnly(std::initializer_list<std::string_view> known) const {
  const auto require_known = [&](const std::string& key, const YamlNode& at) {
    if (std::find(known.begin(), known.end(), key) != known.end()) return;
    at.Fail(fmt::format("unknown key '{}'; known are: {}", key, fmt::join(known, ", ")));
  };
  Keys();  // Throws unless this is a map with plain keys.
  std::set<std::string> seen;
  if (node_.IsMap()) {
    for (const auto& entry : node_) {
      const std::string& key = entry.first.Scalar();
      const YamlNode at = Child(entry.first, path_.empty() ? key : path_ + "." + key);
      require_known(key, at);
      if (!seen.insert(key).second) at.Fail("the key '" + key + "' occurs twice");
    }
  }
  for (const auto& [key, replacement] : overrides_) {
    require_known(key, YamlNode(replacement.node, replacement.origin, key, false));
  }
}

int YamlNode::Size() const {
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
  }
  return elements;
}

double YamlNode::Double() const {
  double value = 0;
  if (!node_.IsScalar()) Fail("expected a number, found " + KindOf(node_));
  const bool parsed = ParseNumber(node_.Scalar(), &value);
  if (parsed && std::isfinite(value)) return value;
  const bool non_finite =
      parsed || (YAML::convert<double>::decode(node_, value) && !std::isfinite(value));
  Fail(std::string("expected a ") + (non_finite ? "finite " : "") + "number, found " +
       KindOf(node_));
}

double YamlNode::PositiveDouble() const {
  const double value = Double();
  if (value <= 0) Fail("must be greater than zero, found " + KindOf(node_));
  return value;
}

long long YamlNode::Int() const {
  long long value = 0;
  if (!node_.IsScalar() || !ParseNumber(node_.Scalar(), &value)) {
    Fail("expected an integer, found " + KindOf(node_));
  }
  return value;
}

bool YamlNode::Bool() const {
  bool value = false;
  if (!node_.IsScalar() || !YAML::convert<bool>::decode(node_, value)) {
    Fail("expected true or false, found " + KindOf(node_));
  }
  return value;
}

std::string YamlNode::String() const {
  if (!node_.IsScalar()) Fail("expected text, found " + KindOf(node_));
  return node_.Scalar();
}

std::vector<double> YamlNode::Doubles() const {
  std::vector<double> values;
  for (const YamlNode& element : Elements()) values.push_back(element.Double());
  return values;
}

std::vector<double> YamlNode::Doubles(int expected_size) const {
  if (Size() != expected_size) {
    Fail("expected " + std::to_string(expected_size) + " numbers, found " + std::to_string(Size()));
  }
  return Doubles();
}

std::vector<std::string> YamlNode::Strings() const {
  std::vector<std::string> values;
  for (const YamlNode& element : Elements()) values.push_back(element.String());
  return values;
}

double YamlNode::DoubleOr(const std::string& key, double fallback) const {
  const std::optional<YamlNode> value = Find(key);
  return value ? value->Double() : fallback;
}

long long YamlNode::IntOr(const std::string& key, long long fallback) const {
  const std::optional<YamlNode> value = Find(key);
  return value ? value->Int() : fallback;
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
  if (!node_.IsNull() && !node_.IsMap()) Fail("expected a map, found " + KindOf(node_));
  overrides_[key] = {Parse(text, origin).node_, origin};
}

}  // namespace planbench
