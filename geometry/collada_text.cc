#include "geometry/collada_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "common/error.h"
#include "common/text.h"
#include "geometry/text_words.h"

namespace planbench {
namespace {

constexpr std::string_view kXmlSpaces = " \t\r\n";

// What assimp leaves out or distorts.
constexpr std::array<std::array<std::string_view, 2>, 5> kRefused = {
    {{"skew", "> cannot be read; export the mesh with transforms applied"},
     {"lookat", "> cannot be read; export the mesh with transforms applied"},
     {"trifans", "> cannot be read; export the mesh as triangles"},
     {"convex_mesh", "> cannot be read; export the mesh itself"},
     {"instance_controller",
      ">: skinned meshes cannot be read; export the mesh without its skeleton"}}};

// Instances of nodes, with what they have instances of: how far they may be in one another, and how
// many they may come to.
constexpr int kDeepestInstance = 100;
constexpr double kMostInstances = 1e5;

// Lines stay where they are.
void BlankOut(std::string_view begin, std::string_view end, std::string* text) {
  for (std::size_t at = text->find(begin); at != std::string::npos; at = text->find(begin, at)) {
    const std::size_t close = text->find(end, at + begin.size());
    const std::size_t last = close == std::string::npos ? text->size() : close + end.size();
    for (; at < last; ++at) {
      if ((*text)[at] != '\n') (*text)[at] = ' ';
    }
  }
}

void SkipXmlSpaces(std::string_view* text) {
  text->remove_prefix(std::min(text->find_first_not_of(kXmlSpaces), text->size()));
}

std::string_view TakeXmlWord(std::string_view* text) {
  SkipXmlSpaces(text);
  const std::string_view word = text->substr(0, text->find_first_of(kXmlSpaces));
  text->remove_prefix(word.size());
  return word;
}

struct ColladaTag {
  std::size_t at = 0;
  std::string_view name;        // "/name" of one that ends an element.
  std::string_view attributes;  // As written.
  std::string_view content;     // Up to the next tag.

  // Nothing if there is none of the name.
  std::optional<std::string_view> Attribute(std::string_view attribute) const {
    for (std::size_t found = attributes.find(attribute); found != std::string_view::npos;
         found = attributes.find(attribute, found + 1)) {
      if (found == 0 || kXmlSpaces.find(attributes[found - 1]) == std::string_view::npos) continue;
      std::string_view rest = attributes.substr(found + attribute.size());
      SkipXmlSpaces(&rest);
      if (!rest.starts_with('=')) continue;
      rest.remove_prefix(1);
      SkipXmlSpaces(&rest);
      if (!rest.starts_with('"') && !rest.starts_with('\'')) continue;
      return rest.substr(1, rest.find(rest.front(), 1) - 1);
    }
    return std::nullopt;
  }

  bool IsWhole() const { return attributes.ends_with('/'); }  // Without an end of its own.

  // The id in the file that its url names; "" if it names none.
  std::string_view Target() const {
    const std::string_view url = Attribute("url").value_or("");
    return url.starts_with('#') ? url.substr(1) : "";
  }
};

class ColladaCheck {
 public:
  ColladaCheck(std::string_view text, const std::string& file) : text_(text), file_(file) {
    ForEachTag([this](const ColladaTag& tag) {
      const auto id = tag.Attribute("id");
      if (id && (tag.name == "geometry" || tag.name == "node")) ids_.emplace(tag.name, *id);
      NoteInstances(tag);
    });
    ForEachTag([this](const ColladaTag& tag) { Check(tag); });
  }

 private:
  template <typename Visit>
  void ForEachTag(Visit visit) const {
    for (std::size_t at = text_.find('<'); at != std::string_view::npos;) {
      const std::size_t next = std::min(text_.find('<', at + 1), text_.size());
      const std::string_view whole = text_.substr(at + 1, next - at - 1);
      const std::size_t end = std::min(whole.find('>'), whole.size());
      const std::string_view inside = whole.substr(0, end);
      ColladaTag tag;
      tag.at = at;
      tag.name = inside.substr(0, inside.find_first_of(" \t\r\n/", 1));
      tag.attributes = inside.substr(tag.name.size());
      tag.content = whole.substr(std::min(end + 1, whole.size()));
      visit(tag);
      at = text_.find('<', next);
    }
  }

  [[noreturn]] void Fail(const ColladaTag& tag, const std::string& what) const {
    const auto line = 1 + std::ranges::count(text_.substr(0, tag.at), '\n');
    throw InputError(fmt::format("{}:{}: <{}{}", file_, line, tag.name, what));
  }

  void Check(const ColladaTag& tag) {
    for (const auto& [name, message] : kRefused) {
      if (tag.name == name) Fail(tag, std::string(message));
    }
    CheckPrimitives(tag);
    if (tag.name == "unit") {
      CheckUnit(tag);
    } else if (tag.name == "rotate") {
      CheckRotate(tag);
    } else if (tag.name == "float_array") {
      CheckFloats(tag);
    } else if (tag.name == "instance_geometry") {
      CheckInstance(tag, "geometry");
    } else if (tag.name == "instance_node") {
      CheckInstance(tag, "node");
      num_instances_ += NumInstances(tag, tag.Target(), 0);
      if (num_instances_ <= kMostInstances) return;
      Fail(tag, fmt::format(">: instances of instances come to more than {}", kMostInstances));
    }
  }

  // Of which node which others are, by what is within it.
  void NoteInstances(const ColladaTag& tag) {
    if (tag.name == "node" && !tag.IsWhole())
      open_nodes_.push_back(tag.Attribute("id").value_or(""));
    if (tag.name == "/node" && !open_nodes_.empty()) open_nodes_.pop_back();
    if (tag.name != "instance_node") return;
    for (const std::string_view node : open_nodes_) instances_[node].push_back(tag.Target());
  }

  // Assimp follows them without an end.
  double NumInstances(const ColladaTag& tag, std::string_view node, int depth) {
    if (depth > kDeepestInstance) {
      Fail(tag, fmt::format(">: its node is within itself, or within more than {} others",
                            kDeepestInstance));
    }
    if (const auto known = num_below_.find(node); known != num_below_.end()) return known->second;
    double number = 1;
    for (const std::string_view other : instances_[node]) {
      number += NumInstances(tag, other, depth + 1);
    }
    num_below_.emplace(node, number);
    return number;
  }

  // Where counts are wrong assimp ends the process, or leaves out what they do not tell of; corners
  // below 0 it takes for the first vertex.
  void CheckPrimitives(const ColladaTag& tag) {
    const bool begins = tag.name == "triangles" || tag.name == "polylist" ||
                        tag.name == "polygons" || tag.name == "tristrips";
    if (begins) {
      primitive_ = tag;
      num_lists_ = 0;
      has_vcount_ = false;
    }
    if (!primitive_) return;
    if (tag.name == "vcount") has_vcount_ = true;
    if (tag.name == "p") {
      if (tag.content.find_first_not_of(kXmlSpaces) != std::string_view::npos) ++num_lists_;
      if (tag.content.find('-') != std::string_view::npos) Fail(tag, ">: a corner is below 0");
      if (primitive_->name == "polylist" && !has_vcount_) Fail(tag, ">: has no <vcount> before it");
    }
    const bool ends = tag.name.starts_with('/') && tag.name.substr(1) == primitive_->name;
    if (!ends && !(begins && tag.IsWhole())) return;
    const std::string_view count = primitive_->Attribute("count").value_or("");
    std::optional<double> lists = ParseNumber(count);
    const bool has_one = primitive_->name == "triangles" || primitive_->name == "polylist";
    if (has_one && lists) lists = std::min(*lists, 1.0);
    if (lists != static_cast<double>(num_lists_)) {
      Fail(*primitive_,
           fmt::format(" count=\"{}\">: it has {} <p> with corners; is the file damaged?",
                       Printable(count), num_lists_));
    }
    primitive_.reset();
  }

  // Assimp takes a unit that is no number for a metre, and scales by any other.
  void CheckUnit(const ColladaTag& tag) const {
    const auto value = tag.Attribute("meter");
    if (!value) return;
    std::string plain(*value);
    std::ranges::replace(plain, ',', '.');  // As some write it.
    std::string_view words = plain;
    const std::optional<double> length = ParseNumber(TakeXmlWord(&words));
    if (length && *length > 0) return;
    Fail(tag,
         fmt::format(" meter=\"{}\">: must be the length of the file's unit in metres, above 0",
                     Printable(*value)));
  }

  // Assimp makes a matrix of it that does not only turn, unless the angle is 0.
  void CheckRotate(const ColladaTag& tag) const {
    std::string_view words = tag.content;
    std::array<double, 4> values{};
    for (double& value : values) {
      const std::optional<double> number = ParseNumber(TakeXmlWord(&words));
      if (!number) Fail(tag, ">: expected four numbers, an axis and an angle");
      value = *number;
    }
    const double length = std::hypot(values[0], values[1], values[2]);
    if (values[3] == 0 || std::abs(length - 1) <= 1e-3) return;
    Fail(tag, fmt::format(">: its axis must be of length 1, and is of {:.4g}", length));
  }

  void CheckFloats(const ColladaTag& tag) const {
    const std::string_view count = tag.Attribute("count").value_or("");
    std::string_view words = tag.content;
    std::size_t number = 0;
    while (!TakeXmlWord(&words).empty()) ++number;
    if (ParseNumber(count) == static_cast<double>(number)) return;
    Fail(tag, fmt::format(" count=\"{}\">: it has {} values; is the file damaged?",
                          Printable(count), number));
  }

  // Assimp leaves it out.
  void CheckInstance(const ColladaTag& tag, std::string_view kind) const {
    const std::string_view target = tag.Target();
    if (!target.empty() && ids_.contains({kind, target})) return;
    Fail(tag, fmt::format(" url=\"{}\">: there is no <{}> of that id in the file",
                          Printable(tag.Attribute("url").value_or("")), kind));
  }

  std::string_view text_;
  const std::string& file_;
  std::set<std::pair<std::string_view, std::string_view>> ids_;  // Of geometries and nodes.

  std::vector<std::string_view> open_nodes_;  // Ids, "" of those without.
  std::map<std::string_view, std::vector<std::string_view>> instances_;
  std::map<std::string_view, double> num_below_;  // Of a node, itself among them.
  double num_instances_ = 0;

  std::optional<ColladaTag> primitive_;  // That is open.
  std::size_t num_lists_ = 0;            // Its <p> that are not empty.
  bool has_vcount_ = false;
};

}  // namespace

void CheckCollada(std::string text, const std::string& file) {
  RefuseUtf16(text, file);
  BlankOut("<!--", "-->", &text);
  BlankOut("<![CDATA[", "]]>", &text);
  ColladaCheck(text, file);
}

}  // namespace planbench
