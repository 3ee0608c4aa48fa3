#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "common/enum_names.h"
#include "common/error.h"
#include "common/yaml_tree.h"

namespace planbench {

/// A YAML node that knows where it stands. Every access is checked, and every failure throws
/// InputError with "file:line: field.path: what is wrong", lines counted from 1.
///
/// Merge keys are applied wherever a map is read: `<<: *defaults` and `<<: [*first, *second]` add
/// what the map itself does not say, earlier maps before later ones. Tags are applied or refused:
/// known are YAML's own (!!str, !!int, !!float, !!bool, !!null, !!binary, !!map, !!seq) and
/// rosparam's !degrees and !radians.
class YamlNode {
 public:
  /// Reads and parses a file: UTF-8 text with one document in it (or none, which reads as a null);
  /// empty ones before and after do not count, so that a file may end in `---`.
  static YamlNode LoadFile(const std::string& path);
  /// Parses `text`; `origin` stands for the file name in error messages.
  static YamlNode Parse(const std::string& text, const std::string& origin);

  bool IsMap() const { return node_->kind == YamlTree::Kind::kMap || !overrides_.empty(); }
  bool IsSequence() const { return node_->kind == YamlTree::Kind::kSequence; }
  bool IsScalar() const { return node_->kind == YamlTree::Kind::kScalar && !IsNull(); }
  bool IsBinary() const;  ///< `!!binary`.
  bool IsNull() const;

  /// The value of `key`; throws if this is no map or lacks the key.
  YamlNode At(const std::string& key) const;
  /// The value of `key`, nothing if the key is absent or its value null; throws if this is no map
  /// or holds the key twice.
  std::optional<YamlNode> Find(const std::string& key) const;
  /// Throws for the first key that is not in `known` (unknown settings are errors; "x-*": whatever
  /// begins with "x-"), or that occurs twice.
  void AllowOnly(std::initializer_list<std::string_view> known) const;
  /// Throws, at the key, for the first one that `accepts` returns a complaint for, or that occurs
  /// twice.
  void RequireKeys(
      const std::function<std::optional<std::string>(const std::string& key)>& accepts) const;
  /// Throws for the first key whose value is null: of a map of settings that is a mistake, not a
  /// wish for the default.
  void RequireValues() const;
  /// The keys of a map, in file order, merged ones last; throws if this is no map.
  std::vector<std::string> Keys() const;

  /// Number of elements; throws if this is no sequence.
  int Size() const;
  YamlNode At(int index) const;
  /// All elements of a sequence; throws if this is no sequence, or has one of `...`, which is where
  /// `ros2 topic echo` cuts a list. Like every access to a list or a text it names what a dump has
  /// left out (`--no-arr`, `--no-str`) as such.
  std::vector<YamlNode> Elements() const;

  /// A finite decimal number, exactly rounded; NaN and infinities throw. `!degrees 90` and
  /// `deg(90)` are 1.57..., `!radians pi/2` and `rad(pi/2)` likewise (products and quotients of
  /// numbers and pi).
  /// A byte as it is where it stands for a number: one control character, or one byte of !!binary.
  std::optional<int> RawByte() const;
  double Double() const;
  double PositiveDouble() const;                         ///< A finite number greater than zero.
  double NonNegativeDouble() const;                      ///< The same, or zero.
  double DoubleWithin(double least, double most) const;  ///< A number from `least` to `most`.
  long long Int() const;                                 ///< A decimal integer.
  int IntWithin(int least, int most) const;              ///< The same, from `least` to `most`.
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
  /// A sequence of numbers from -128 to 255, or `!!binary` base64.
  std::vector<std::uint8_t> Bytes() const;

  /// Shorthands for optional keys of a map.
  double DoubleOr(const std::string& key, double fallback) const;
  bool BoolOr(const std::string& key, bool fallback) const;
  std::string StringOr(const std::string& key, const std::string& fallback) const;

  /// Replaces `key` (of a map or null node) by `text` parsed as YAML. A key with dots that the map
  /// does not have leads into maps: `ompl.goal_bias` is `goal_bias` of the map `ompl`, which is
  /// made if it is missing. Errors about the value will begin with `origin`, e.g. "--set range" or
  /// "lineup.yaml:4: contestants.mine.set.range"; those about a map that it is put into with where
  /// that stands, and with `origin` if it was made for the value. Copies made before keep the old
  /// value. Throws for text that is no YAML, and where a map should be and is none.
  void Override(const std::string& key, const std::string& text, const std::string& origin);

  /// "file:line: field.path".
  std::string Where() const;
  [[noreturn]] void Fail(const std::string& what) const;
  /// Notes, once, what was read otherwise than it is written; see warnings.
  void Warn(const std::string& what) const;
  /// Of the whole document, "file:line: field.path: what", in the order they were noted.
  const std::vector<std::string>& warnings() const { return document_->warnings; }

 private:
  using Node = YamlTree::Node;
  /// What all nodes of a text have in common.
  struct Document {
    Document(const std::string& text, std::string of) : origin(std::move(of)), tree(text) {}
    std::string origin;
    bool has_lines = true;     ///< False for a command line or a message: one line, no file.
    std::size_t num_told = 0;  ///< Bytes of all paths, at their beginning, that `origin` tells.
    YamlTree tree;
    std::vector<std::string> warnings;
    std::unordered_set<std::string> warned;  ///< The same.
  };

  YamlNode(const Node* node, std::shared_ptr<Document> document, std::string path)
      : node_(node), document_(std::move(document)), path_(std::move(path)) {}

  YamlNode Child(const Node* node, const std::string& path) const {
    return YamlNode(node, document_, path);
  }
  std::string PathOf(const std::string& key) const {
    return path_.empty() ? key : path_ + "." + key;
  }
  // `text` at `key` of this map, but of a text without lines that `origin` stands for.
  std::shared_ptr<YamlNode> Foreign(const std::string& key, const std::string& text,
                                    const std::string& origin) const;
  // The entries of a map with what it merges; throws for keys that are no text or occur twice.
  std::vector<std::pair<const Node*, const Node*>> Entries(const Node& map) const;
  // The value of `key` in `map` or in what it merges, null if it has none.
  const Node* FindIn(const Node& map, const std::string& key) const;
  // Refuses tags that are not known, what contains itself, and merge keys that merge no maps.
  void CheckTree(std::vector<const Node*>* ancestors, int* last_position) const;
  void CheckMerge(const Node& value) const;
  // Refuses what stands for a list or a text that a dump has left out.
  void RequirePrinted() const;
  // Refuses a scalar whose tag is not among `allowed` (short forms).
  void RequireTag(std::initializer_list<std::string_view> allowed, const char* wanted) const;

  const Node* node_;  // Of the document's tree.
  std::shared_ptr<Document> document_;
  std::string path_;
  // Beside the tree and not in it, because copies share that.
  std::map<std::string, std::shared_ptr<const YamlNode>> overrides_;
};

/// What `read` returns; its InputErrors, which do not know the field at fault, say where it stands.
template <typename Read>
auto AtField(const YamlNode& field, const Read& read) {
  try {
    return read();
  } catch (const InputError& error) {
    field.Fail(error.what());
  }
}

}  // namespace planbench
