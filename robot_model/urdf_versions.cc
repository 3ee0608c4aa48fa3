#include "robot_model/urdf_versions.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <initializer_list>
#include <optional>
#include <utility>
#include <vector>

#include "common/error.h"
#include "robot_model/xml_text.h"

namespace planbench {
namespace {

class UrdfRewriter {
 public:
  UrdfRewriter(std::string_view text, const std::string& origin) : text_(text), origin_(origin) {
    XmlTagReader tags(text);
    while (const auto tag = tags.Next()) {
      if (tag->closing) {
        if (IsOfCapsule()) Replace(tag->element, "cylinder");
        open_.pop_back();
        continue;
      }
      open_.push_back(*tag);
      Rewrite(*tag);
      if (tag->empty) open_.pop_back();
    }
    result_.text += text.substr(at_);
  }

  Urdf10 result() && { return std::move(result_); }

 private:
  // Of open_, whose last is the tag at hand.
  bool IsAt(std::initializer_list<std::string_view> path) const {
    return std::ranges::equal(path, open_, {}, {}, [](const XmlTag& tag) { return tag.element; });
  }
  bool IsOfCapsule() const {
    return IsAt({"robot", "link", "collision", "geometry", "capsule"}) ||
           IsAt({"robot", "link", "visual", "geometry", "capsule"});
  }

  void Rewrite(const XmlTag& tag) {
    if (IsAt({"robot"})) {
      RewriteVersion(tag);
    } else if (IsAt({"robot", "link"})) {
      collisions_ = 0;
    } else if (IsAt({"robot", "link", "collision"})) {
      ++collisions_;
    } else if (IsAt({"robot", "joint", "origin"}) ||
               IsAt({"robot", "link", "collision", "origin"}) ||
               IsAt({"robot", "link", "visual", "origin"}) ||
               IsAt({"robot", "link", "inertial", "origin"})) {
      RewriteOrientation(tag);
    } else if (IsOfCapsule()) {
      RewriteCapsule(tag);
    }
  }

  void RewriteVersion(const XmlTag& tag) {
    for (const XmlAttribute& attribute : tag.Attributes()) {
      if (attribute.name != "version") continue;
      if (attribute.value != "1.0" && attribute.value != "1.1" && attribute.value != "1.2") {
        throw InputError(
            fmt::format("{}:{}: <robot>: version: expected a URDF of 1.0, 1.1 or 1.2, found '{}'",
                        origin_, tag.line, attribute.value));
      }
      Replace(attribute.value, "1.0");
    }
  }

  void RewriteOrientation(const XmlTag& tag) {
    for (const XmlAttribute& attribute : tag.Attributes()) {
      if (attribute.name != "quat_xyzw") continue;
      if (tag.Attribute("rpy")) Fail(tag, "has both rpy and quat_xyzw");
      const std::optional<std::vector<double>> q = ReadNumbers(attribute.value);
      if (!q || q->size() != 4) {
        Fail(tag, fmt::format("quat_xyzw: expected four numbers, found '{}'", attribute.value));
      }
      Eigen::Quaterniond rotation((*q)[3], (*q)[0], (*q)[1], (*q)[2]);
      if (!rotation.coeffs().allFinite() || rotation.norm() < 1e-9) {
        Fail(tag, "quat_xyzw: must be finite and not zero");
      }
      rotation.normalize();
      const Eigen::Vector3d ypr = rotation.toRotationMatrix().eulerAngles(2, 1, 0);
      Replace(attribute.name, "rpy");
      Replace(attribute.value, fmt::format("{} {} {}", ypr[2], ypr[1], ypr[0]));
    }
  }

  void RewriteCapsule(const XmlTag& tag) {
    if (!tag.Attribute("radius") || !tag.Attribute("length")) Fail(tag, "needs radius and length");
    Replace(tag.element, "cylinder");
    if (open_[2].element != "collision") return;
    result_.capsules[open_[1].Attribute("name").value_or("")].insert(collisions_ - 1);
  }

  [[noreturn]] void Fail(const XmlTag& tag, const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {} '{}': <{}>: {}", origin_, tag.line, open_[1].element,
                                 open_[1].Attribute("name").value_or(""), tag.element, what));
  }

  void Replace(std::string_view old, std::string_view by) {
    const auto begin = static_cast<std::size_t>(old.data() - text_.data());
    result_.text += text_.substr(at_, begin - at_);
    result_.text += by;
    at_ = begin + old.size();
  }

  std::string_view text_;
  const std::string& origin_;
  std::vector<XmlTag> open_;
  int collisions_ = 0;  // Of the link so far.
  std::size_t at_ = 0;  // What comes before is in the result.
  Urdf10 result_;
};

}  // namespace

Urdf10 ToUrdf10(std::string_view text, const std::string& origin) {
  return UrdfRewriter(text, origin).result();
}

}  // namespace planbench
