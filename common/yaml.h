#pragma once

#include <yaml-cpp/node/node.h>

#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/enum_names.h"

namespace planbench {

/// A YAML node that knows where it stands. Every access is checked, and every failure throws
/// InputError with "file:line: field.path: what is wrong", lines counted from 1.
class YamlNode {
 public:
  /// Reads and parses a file; its whole text must be one document (or empty, which reads as a
  /// null).
  static YamlNode LoadFile(const std::string& path);
  /// Parses `text`; `origin` stands for the file name in error messages.
  static YamlNode Parse(const std::string& text, const std::string& origin);

  bool IsMap() const { return node_.IsMap() || !overrides_.empty(); }
  bool IsSequence() const { return node_.IsSequence(); }
  bool IsScalar() const { return node_.IsScalar(); }
  bool IsNull() const { return node_.IsNull() && overrides_.empty(); }

  /// The value of `key`; throws if this is no map or lacks the key.
  YamlNode At(const std::string& key) const;
  /// The value of `key`, nothing if the key is absent or its value null; throws if this is no map
  /// or holds the key twice.
  std::optional<YamlNode> Find(const std::string& key) const;
  /// Throws for the first key that is not in `known` (unknown settings are errors), or that occurs
  /// twice.
  void AllowOnly(std::initializer_list<std::string_view> known) const;
  /// The keys of a map, in file order; throws if this is no map.
  std::vector<std::string> Keys() const;

  /// Number of elements; throws if this is no sequence.
  int Size() const;
  YamlNode At(int index) const;
  /// All elements of a sequence; throws if this is no sequence.
  std::vector<YamlNode> Elements() const;

  double Double() const;  ///< A finite decimal number, exactly rounded; NaN and infinities throw.
  double PositiveDouble() const;  ///< A finite number greater than zero.
  long long Int() const;          ///< A decimal integer.
  bool Bool() const;
  std::string String() const;
  template <typename Value>  ///< One of the names of an enum (enum_names.h).
  Value Enum() const {
    const std::string name = String();
    const std::optional<Value> value = ParseEnum<Value>(name);
    if (!value) Fail("expected " + EnumChoices<Value>() + ", found '" + name + "'");
    return *value;
  }
  std::vector<double> Doubles() const;                   ///< A sequence of finite numbers.
  std::vector<double> Doubles(int expected_size) const;  ///< The same, of a given length.
  std::vector<std::string> Strings() const;

  /// Shorthands for optional keys of a map.
  double DoubleOr(const std::string& key, double fallback) const;
  long long IntOr(const std::string& key, long long fallback) const;
  bool BoolOr(const std::string& key, bool fallback) const;
  std::string StringOr(const std::string& key, const std::string& fallback) const;

  /// Replaces `key` (of a map or null node) by `text` parsed as YAML. Errors about it will name
  /// `origin`, e.g. "--set range" or "PLAN_REQUEST_RRTC parameter range". Copies made before keep
  /// the old value.
  void Override(const std::string& key, const std::string& text, const std::string& origin);

  /// "file:line: field.path".
  std::string Where() const;
  [[noreturn]] void Fail(const std::string& what) const;

 private:
  // A value given by Override, and where it came from.
  struct Replacement {
    YAML::Node node;
    std::string origin;
  };

  YamlNode(YAML::Node node, std::string origin, std::string path, bool has_lines)
      : node_(std::move(node)),
        origin_(std::move(origin)),
        path_(std::move(path)),
        has_lines_(has_lines) {}

  YamlNode Child(const YAML::Node& node, const std::string& path) const;

  YAML::Node node_;
  std::string origin_;
  std::string path_;
  bool has_lines_ =
      true;  // False for what comes from a command line or a message: one line, no file.
  // Beside the tree and not in it, because copies of a YAML::Node share what they point to.
  std::map<std::string, Replacement> overrides_;
};

}  // namespace planbench
