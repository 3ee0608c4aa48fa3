#include "robot_model/urdf_document.h"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <initializer_list>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "common/error.h"
#include "robot_model/urdf_versions.h"
#include "robot_model/xml_text.h"

namespace planbench {
namespace {

// Keeps what urdfdom reports while it lives, instead of letting it go to the terminal. The handler
// is process-wide in console_bridge: one capture at a time.
class ReportCapture : private console_bridge::OutputHandler {
 public:
  ReportCapture() : lock_(Mutex()) { console_bridge::useOutputHandler(this); }
  ~ReportCapture() override { console_bridge::restorePreviousOutputHandler(); }

  /// Everything reported as an error, in one line.
  const std::string& errors() const { return errors_; }

 private:
  static std::mutex& Mutex() {
    static std::mutex mutex;
    return mutex;
  }

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR) return;
    if (!errors_.empty()) errors_ += "; ";
    for (const char c : text) errors_ += c == '\n' ? ' ' : c;
  }

  std::lock_guard<std::mutex> lock_;
  std::string errors_;
};

// Notes where links and joints are defined, and refuses what urdfdom passes over in silence, a
// second element where it takes the first, and links that are children of each other, which it
// passes over, too, or reports without a place.
class ElementFinder {
 public:
  ElementFinder(std::string_view text, const std::string& origin, UrdfDocument* document)
      : origin_(origin), document_(*document) {
    XmlTagReader tags(text);
    while (const auto tag = tags.Next()) {
      if (tag->closing) {
        open_.pop_back();
        continue;
      }
      Note(*tag);
      CheckOnlyOne(*tag);
      if (!tag->empty) open_.push_back({*tag, {}});
    }
    CheckLoops();
  }

 private:
  struct Open {
    XmlTag tag;
    std::vector<std::string_view> only_ones;  // Those that it holds already.
  };
  struct JointEnds {
    std::string name;
    int line;
    std::string parent;
    std::string child;
  };

  // Elsewhere (transmissions, gazebo) the same tags mention them.
  void Note(const XmlTag& tag) {
    if (Within({"joint"}) && !joints_.empty()) {
      if (tag.element == "parent") joints_.back().parent = tag.Attribute("link").value_or("");
      if (tag.element == "child") joints_.back().child = tag.Attribute("link").value_or("");
      if (tag.element == "axis") {
        document_.joint_axes.try_emplace(joints_.back().name, tag.Attribute("xyz").value_or(""));
      }
      if (tag.element == "safety_controller") {
        const std::string& joint = joints_.back().name;
        if (tag.Attribute("soft_lower_limit")) document_.with_soft_lower.insert(joint);
        if (tag.Attribute("soft_upper_limit")) document_.with_soft_upper.insert(joint);
      }
    }
    const std::string name = tag.Attribute("name").value_or("");
    // What is not empty defines one, be it within a link.
    if (tag.element == "material" && !tag.empty && !name.empty()) {
      document_.material_lines.insert_or_assign(name, tag.line);
    }
    if (open_.size() != 1 || (tag.element != "link" && tag.element != "joint")) return;
    if (name.empty()) {
      throw InputError(fmt::format("{}:{}: <{}>: has no name", origin_, tag.line, tag.element));
    }
    if (tag.element == "link") {
      document_.link_lines.try_emplace(name, tag.line);
    } else {
      document_.joint_lines.try_emplace(name, tag.line);
      document_.joint_order.try_emplace(name, static_cast<int>(document_.joint_order.size()));
      joints_.push_back({name, tag.line, "", ""});
    }
  }

  bool Within(std::initializer_list<std::string_view> path) const {
    return open_.size() == 1 + path.size() &&
           std::equal(path.begin(), path.end(), open_.begin() + 1,
                      [](std::string_view name, const Open& o) { return o.tag.element == name; });
  }

  bool IsShape(const XmlTag& tag) const {
    return Within({"link", "collision", "geometry"}) && tag.element.find(':') == tag.element.npos;
  }

  bool IsOnlyOne(const XmlTag& tag) const {
    static const std::set<std::string_view> kOfJoint = {
        "origin", "parent", "child", "axis", "limit", "mimic", "safety_controller"};
    if (Within({"joint"})) return kOfJoint.contains(tag.element);
    return IsShape(tag) || (Within({"link", "collision"}) &&
                            (tag.element == "geometry" || tag.element == "origin"));
  }

  void CheckOnlyOne(const XmlTag& tag) {
    if (!IsOnlyOne(tag)) return;
    std::vector<std::string_view>& before = open_.back().only_ones;
    const auto other = IsShape(tag) ? before.begin() : std::ranges::find(before, tag.element);
    if (other != before.end()) {
      const XmlTag& place = open_[1].tag;
      throw InputError(fmt::format(
          "{}:{}: {} '{}': <{}> holds <{}> and <{}>, but can hold one{}", origin_, tag.line,
          place.element, place.Attribute("name").value_or(""), open_.back().tag.element, *other,
          tag.element, place.element == "link" ? "; give each a <collision> of its own" : ""));
    }
    before.push_back(tag.element);
  }

  void CheckLoops() const {
    std::map<std::string, const JointEnds*> joint_to;
    for (const JointEnds& joint : joints_) joint_to.try_emplace(joint.child, &joint);
    std::map<const JointEnds*, std::string> met_from;
    for (const auto& [link, line] : document_.link_lines) {
      // Towards the root, until a joint comes again. urdfdom names parents that are no links.
      auto joint = joint_to.find(link);
      while (joint != joint_to.end() && met_from.try_emplace(joint->second, link).second) {
        joint = joint_to.find(joint->second->parent);
      }
      if (joint == joint_to.end() || met_from.at(joint->second) != link) continue;
      std::vector<const JointEnds*> loop = {joint->second};
      while (loop.back()->parent != joint->first) {
        loop.push_back(joint_to.at(loop.back()->parent));
      }
      const bool has_root = std::ranges::any_of(
          document_.link_lines, [&](const auto& one) { return !joint_to.contains(one.first); });
      FailLoop(loop, has_root);
    }
  }

  // Of a robot in the order of its links the joint that made the root a child is the last one of
  // the loop, the one that left the tree the first.
  [[noreturn]] void FailLoop(const std::vector<const JointEnds*>& loop, bool has_root) const {
    const auto line = [](const JointEnds* joint) { return joint->line; };
    const JointEnds& wrong = **(has_root ? std::ranges::min_element(loop, {}, line)
                                         : std::ranges::max_element(loop, {}, line));
    std::string links;
    for (const JointEnds* joint : loop) links += joint->child + ", ";
    throw InputError(fmt::format(
        "{}:{}: joint '{}': the links are children of each other in a loop ({}{}), and none is the "
        "root; a robot must be a tree",
        origin_, wrong.line, wrong.name, links, loop.front()->child));
  }

  const std::string& origin_;
  UrdfDocument& document_;
  std::vector<Open> open_;
  std::vector<JointEnds> joints_;
};

// ":LINE" of the first link, joint or material that urdfdom's report names, in brackets or quotes;
// "" if it names none.
std::string LineOfReport(const std::string& report, const UrdfDocument& document) {
  std::size_t first = std::string::npos;
  int line = 0;
  for (const auto* lines :
       {&document.joint_lines, &document.link_lines, &document.material_lines}) {
    for (const auto& [name, at_line] : *lines) {
      for (const auto& quoted : {"[" + name + "]", "'" + name + "'"}) {
        const std::size_t at = report.find(quoted);
        if (at >= first) continue;
        first = at;
        line = at_line;
      }
    }
  }
  return first == std::string::npos ? "" : fmt::format(":{}", line);
}

// urdfdom reports other descriptions (SDF, MuJoCo's) and other files as empty.
void CheckOutermost(std::string_view text, const std::string& origin) {
  const std::optional<XmlTag> outermost = XmlTagReader(text).Next();
  if (!outermost) {
    throw InputError(
        fmt::format("{}:1: not a valid URDF: it has no XML element; expected <robot>", origin));
  }
  if (outermost->element != "robot") {
    throw InputError(
        fmt::format("{}:{}: not a valid URDF: its outermost element is <{}>; expected "
                    "<robot>",
                    origin, outermost->line, outermost->element));
  }
  if (!outermost->Attribute("name")) {
    throw InputError(
        fmt::format("{}:{}: not a valid URDF: <robot> has no name", origin, outermost->line));
  }
}

}  // namespace

UrdfDocument ParseUrdfDocument(const std::string& urdf_text, const std::string& origin) {
  CheckXmlText(urdf_text, origin);
  CheckOutermost(urdf_text, origin);
  UrdfDocument document;
  const ElementFinder found(urdf_text, origin, &document);
  Urdf10 urdf = ToUrdf10(urdf_text, origin);
  document.capsules = std::move(urdf.capsules);
  std::string errors;
  const auto fail = [&](const std::string& report) {
    throw InputError(
        fmt::format("{}{}: not a valid URDF: {}", origin, LineOfReport(report, document), report));
  };
  {
    const ReportCapture capture;
    try {
      document.model = urdf::parseURDF(urdf.text);
    } catch (const std::exception& error) {
      // Some malformed attributes come out as exceptions of urdfdom's own.
      fail(error.what());
    }
    errors = capture.errors();
  }
  // urdfdom goes on without a collision geometry that it cannot parse; the robot would then be
  // smaller than meant, so that an error it reports is one even where it returns a model.
  if (document.model == nullptr || !errors.empty()) {
    fail(errors.empty() ? "urdfdom gives no reason" : errors);
  }
  return document;
}

}  // namespace planbench
