#pragma once

#include <deque>
#include <string>
#include <utility>
#include <vector>

namespace planbench {

/// A YAML text as a tree, as it was written: an alias is the node that it stands for, which may be
/// one around it, and nothing is merged. Not to be copied: nodes point to each other.
class YamlTree {
 public:
  enum class Kind { kNull, kScalar, kSequence, kMap };
  struct Node {
    Kind kind = Kind::kNull;
    bool is_quoted = false;             ///< Or tagged "!".
    std::string tag;                    ///< In its short form ("!!int"); "" if it has none.
    std::string text;                   ///< Of a scalar.
    std::vector<const Node*> elements;  ///< Of a sequence.
    std::vector<std::pair<const Node*, const Node*>> entries;  ///< Of a map, in file order.
    int line = 0;                                              ///< From 1; 0: it is in no text.
    int position = -1;  ///< Of its first character in the text; -1 likewise.
  };

  /// Throws YAML::Exception for what is no YAML.
  explicit YamlTree(const std::string& text);
  YamlTree(const YamlTree&) = delete;
  YamlTree& operator=(const YamlTree&) = delete;

  /// The roots, one a document.
  const std::vector<const Node*>& documents() const { return documents_; }

 private:
  class Builder;

  std::deque<Node> nodes_;
  std::vector<const Node*> documents_;
};

}  // namespace planbench
