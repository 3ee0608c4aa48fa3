#include "geometry/collada_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "common/error.h"
#include "common/text.h"
#include "geometry/text_words.h"

namespace planbench {
namespace {

constexpr std::string_view kXmlSpaces = " \t\r\n";

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
};

class ColladaCheck {
 public:
  ColladaCheck(std::string_view text, const std::string& file) : text_(text), file_(file) {
    ForEachTag([this](const ColladaTag& tag) {
      const auto id = tag.Attribute("id");
      if (id && (tag.name == "geometry" || tag.name == "node")) ids_.emplace(tag.name, *id);
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

  void Check(const ColladaTag& tag) const {
    if (tag.name == "unit") {
      CheckUnit(tag);
    } else if (tag.name == "skew") {
      Fail(tag, "> cannot be read; export the mesh with transforms applied");
    } else if (tag.name == "rotate") {
      CheckRotate(tag);
    } else if (tag.name == "float_array") {
      CheckFloats(tag);
    } else if (tag.name == "instance_geometry") {
      CheckInstance(tag, "geometry");
    } else if (tag.name == "instance_node") {
      CheckInstance(tag, "node");
    } else if (tag.name == "instance_controller") {
      Fail(tag, ">: skinned meshes cannot be read; export the mesh without its skeleton");
    }
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
    const std::string_view url = tag.Attribute("url").value_or("");
    if (url.starts_with('#') && ids_.contains({kind, url.substr(1)})) return;
    Fail(tag, fmt::format(" url=\"{}\">: there is no <{}> of that id in the file", Printable(url),
                          kind));
  }

  std::string_view text_;
  const std::string& file_;
  std::set<std::pair<std::string_view, std::string_view>> ids_;  // Of geometries and nodes.
};

}  // namespace

void CheckCollada(std::string text, const std::string& file) {
  RefuseUtf16(text, file);
  BlankOut("<!--", "-->", &text);
  BlankOut("<![CDATA[", "]]>", &text);
  ColladaCheck(text, file);
}

}  // namespace planbench
