#include "robot_model/urdf_remarks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <map>

#include "common/text.h"
#include "robot_model/xml_text.h"

namespace planbench {
namespace {

using Names = std::vector<std::string_view>;

// What counts inside an element.
struct KnownElement {
  Names elements;
  Names attributes;
};

const std::map<std::string_view, KnownElement>& KnownElements() {
  static const std::map<std::string_view, KnownElement> known = {
      {"robot", {{"link", "joint"}, {"name", "version"}}},
      {"link", {{"collision"}, {"name"}}},
      {"collision", {{"origin", "geometry"}, {"name"}}},
      {"geometry", {{"box", "sphere", "cylinder", "capsule", "mesh"}, {}}},
      {"box", {{}, {"size"}}},
      {"sphere", {{}, {"radius"}}},
      {"cylinder", {{}, {"radius", "length"}}},
      {"capsule", {{}, {"radius", "length"}}},
      {"mesh", {{}, {"filename", "scale"}}},
      {"origin", {{}, {"xyz", "rpy", "quat_xyzw"}}},
      {"joint",
       {{"origin", "parent", "child", "axis", "limit", "mimic", "safety_controller"},
        {"name", "type"}}},
      {"parent", {{}, {"link"}}},
      {"child", {{}, {"link"}}},
      {"axis", {{}, {"xyz"}}},
      {"limit",
       {{}, {"lower", "upper", "velocity", "effort", "acceleration", "deceleration", "jerk"}}},
      {"mimic", {{}, {"joint", "multiplier", "offset"}}},
      {"safety_controller",
       {{}, {"soft_lower_limit", "soft_upper_limit", "k_position", "k_velocity"}}},
  };
  return known;
}

// The one of `known` that another name was meant to be, "" if it is one or near none.
std::string MeantBy(std::string_view name, const Names& known) {
  if (std::ranges::find(known, name) != known.end() || name.find(':') != name.npos) return "";
  const std::string nearest = NearestName(name, known);
  // The beginning of another name is another name: collision_checking.
  const auto size = static_cast<int>(name.size()) - static_cast<int>(nearest.size());
  return std::abs(size) <= 2 ? nearest : "";
}

class UnheededFinder {
 public:
  UnheededFinder(std::string_view text, const std::string& origin) : origin_(origin) {
    XmlTagReader tags(text);
    while (const auto tag = tags.Next()) {
      if (tag->closing) {
        open_.pop_back();
        continue;
      }
      open_.push_back({*tag, Known(*tag)});
      if (open_.back().known != nullptr) RemarkAttributes(*tag);
      if (tag->empty) open_.pop_back();
    }
    if (num_in_degrees_ > 1) {
      remarks_[in_degrees_] += fmt::format("; likewise {} more", num_in_degrees_ - 1);
    }
  }

  const std::vector<std::string>& remarks() const { return remarks_; }

 private:
  struct Open {
    XmlTag tag;
    const KnownElement* known;  // Null where nothing counts.
  };

  // What is known of an element where it stands; remarks on it if that is nothing.
  const KnownElement* Known(const XmlTag& tag) {
    static const Names kOutermost = {"robot"};
    if (!open_.empty() && open_.back().known == nullptr) return nullptr;
    const Names& counting = open_.empty() ? kOutermost : open_.back().known->elements;
    if (const std::string meant = MeantBy(tag.element, counting); !meant.empty()) {
      Remark(tag,
             fmt::format("<{}> is unknown and does not count; is it <{}>?", tag.element, meant));
    }
    if (std::ranges::find(counting, tag.element) == counting.end()) return nullptr;
    const auto known = KnownElements().find(tag.element);
    return known == KnownElements().end() ? nullptr : &known->second;
  }

  void RemarkAttributes(const XmlTag& tag) {
    for (const XmlAttribute& attribute : tag.Attributes()) {
      const std::string meant = MeantBy(attribute.name, open_.back().known->attributes);
      if (meant.empty()) continue;
      Remark(tag, fmt::format("<{}>: the attribute {} is unknown and does not count; is it {}?",
                              tag.element, attribute.name, meant));
    }
    if (tag.element == "axis" && open_[1].tag.Attribute("type") == "planar") RemarkPlane(tag);
    if (tag.element == "origin") RemarkDegrees(tag);
  }

  void RemarkPlane(const XmlTag& axis) {
    const auto xyz = ReadNumbers(axis.Attribute("xyz").value_or(""));
    if (!xyz || xyz->size() != 3 || ((*xyz)[0] == 0 && (*xyz)[1] == 0)) return;
    Remark(axis,
           "<axis>: does not count; a planar joint moves along x and y of its frame and turns "
           "about z, as in MoveIt");
  }

  // No angle needs more than a turn: degrees are likelier. One remark tells of all.
  void RemarkDegrees(const XmlTag& origin) {
    constexpr double kFullTurn = 6.3;  // rad, with what 2 pi is rounded to.
    const auto rpy = ReadNumbers(origin.Attribute("rpy").value_or(""));
    if (!rpy) return;
    const auto wide = std::ranges::find_if(*rpy, [](double a) { return std::abs(a) > kFullTurn; });
    if (wide == rpy->end()) return;
    if (num_in_degrees_++ > 0) return;
    in_degrees_ = remarks_.size();
    Remark(origin, fmt::format("<origin>: rpy turns by {:g} rad; are those degrees? URDFs are in "
                               "radians",
                               *wide));
  }

  // "joint 'name': " inside a link or joint.
  void Remark(const XmlTag& tag, const std::string& what) {
    std::string place;
    if (open_.size() > 1) {
      const XmlTag& of = open_[1].tag;
      place = fmt::format("{} '{}': ", of.element, of.Attribute("name").value_or(""));
    }
    remarks_.push_back(fmt::format("{}:{}: {}{}", origin_, tag.line, place, what));
  }

  const std::string& origin_;
  std::vector<Open> open_;
  std::vector<std::string> remarks_;
  int num_in_degrees_ = 0;      // Origins.
  std::size_t in_degrees_ = 0;  // The remark that tells of them, if there is one.
};

}  // namespace

std::vector<std::string> RemarkUnheeded(std::string_view urdf_text, const std::string& origin) {
  return UnheededFinder(urdf_text, origin).remarks();
}

}  // namespace planbench
