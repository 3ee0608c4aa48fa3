#include "common/yaml_tree.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <sstream>
#include <string_view>

namespace planbench {

// Makes the tree while yaml-cpp reads the text, which is most of the work: its own builder would
// have to read it a second time (see OnDocumentStart), and its nodes take longer to make and to
// look into.
class YamlTree::Builder final : public YAML::EventHandler {
 public:
  explicit Builder(YamlTree* tree) : tree_(tree) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    // yaml-cpp 0.7 reads documents without end where a bracket closes that none has opened.
    if (mark.pos == start_) {
      throw YAML::ParserException(mark, "nothing is open that could end here");
    }
    start_ = mark.pos;
    anchors_.clear();
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    Node* null = Make(Kind::kNull, mark, "", anchor);
    if (!open_.empty() && open_.back().key != nullptr) {
      // yaml-cpp 0.7 takes for a key what stands without a colon at the end of a document, and its
      // place for the value's. That of a key behind a question mark, which needs none, is the mark.
      if (open_.back().is_block && open_.back().key->position == mark.pos) {
        throw YAML::ParserException(mark, "a key without its colon");
      }
      // The mark of a value that is left out is that of what comes next.
      null->line = open_.back().key->line;
    }
    Add(null);
  }
  void OnAlias(const YAML::Mark& /*mark*/, YAML::anchor_t anchor) override {
    Add(anchors_.at(anchor));
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    Node* scalar = Make(Kind::kScalar, mark, tag, anchor);
    scalar->text = value;
    Add(scalar);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    Open(Make(Kind::kSequence, mark, tag, anchor));
  }
  void OnSequenceEnd() override { open_.pop_back(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value style) override {
    Open(Make(Kind::kMap, mark, tag, anchor));
    open_.back().is_block = style == YAML::EmitterStyle::Block;
  }
  void OnMapEnd() override { open_.pop_back(); }

 private:
  // A sequence or map that has not ended.
  struct Collection {
    Node* node;
    const Node* key = nullptr;  // Of a map, one that lacks its value.
    bool is_block = false;      // A map without braces.
  };

  Node* Make(Kind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    constexpr std::string_view kYaml = "tag:yaml.org,2002:";
    Node& node = tree_->nodes_.emplace_back();
    node.kind = kind;
    node.is_quoted = tag == "!";
    // yaml-cpp gives "?" to what is plain and "!" to what is quoted.
    if (tag != "?" && tag != "!") {
      node.tag = tag.starts_with(kYaml) ? "!!" + tag.substr(kYaml.size()) : tag;
    }
    node.line = mark.line + 1;
    node.position = mark.pos;
    if (anchor != YAML::NullAnchor) {
      anchors_.resize(anchor + 1);
      anchors_[anchor] = &node;
    }
    return &node;
  }

  void Add(const Node* node) {
    if (open_.empty()) {
      tree_->documents_.push_back(node);
      return;
    }
    Collection& parent = open_.back();
    if (parent.node->kind == Kind::kSequence) {
      parent.node->elements.push_back(node);
    } else if (parent.key == nullptr) {
      parent.key = node;
    } else {
      parent.node->entries.emplace_back(parent.key, node);
      parent.key = nullptr;
    }
  }

  void Open(Node* node) {
    Add(node);
    open_.push_back({node});
  }

  YamlTree* tree_;
  std::vector<Collection> open_;      // The innermost last.
  std::vector<const Node*> anchors_;  // Of the document, by number from 1.
  int start_ = -1;                    // Of the document; its position.
};

YamlTree::YamlTree(const std::string& text) {
  // yaml-cpp 0.7 takes a quote that is not closed where the text ends, but not where a document
  // does.
  std::istringstream stream(text + (text.ends_with('\n') ? "..." : "\n..."));
  YAML::Parser parser(stream);
  Builder builder(this);
  while (parser.HandleNextDocument(builder)) {
  }
}

}  // namespace planbench
