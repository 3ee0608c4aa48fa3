#include "robot_tools/make_robot.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <regex>
#include <set>

#include "common/command_line.h"
#include "common/error.h"
#include "common/progress_line.h"
#include "common/read_text.h"
#include "robot_model/link_spheres.h"
#include "robot_model/motion_bound.h"
#include "robot_model/robot_folder.h"
#include "robot_model/srdf.h"
#include "robot_tools/group_proposal.h"
#include "robot_tools/joint_draw.h"
#include "robot_tools/link_bodies.h"
#include "robot_tools/link_chain.h"
#include "robot_tools/mesh_files.h"
#include "robot_tools/pair_descent.h"
#include "robot_tools/pair_sampling.h"
#include "robot_tools/robot_writer.h"
#include "sphere_fitting/outer_spheres.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;
using LinkPairs = std::vector<std::pair<int, int>>;

constexpr int kMostSpheresOfALink = 100;
constexpr int kGroupSamples = 1000;
constexpr std::size_t kWorstPairs = 5;
constexpr char kButPosed[] = " but planar and floating ones";

// A fiftieth of how far the robot reaches, in mm, and no more than arms of a metre need. Along a
// prismatic joint that is half of its travel, as an arm that reaches r sweeps 2 r.
double SuggestEdgeResolution(const Robot& robot) {
  double reach = 0;
  for (const PlanningGroup& group : robot.groups) {
    const MotionBound bound(robot.model, group, robot.model.DefaultPositions(), robot.spheres);
    for (int j = 0; j < group.space.size(); ++j) {
      const JointSpace::Joint& joint = group.space.joint(j);
      const double swept = joint.prismatic ? (joint.upper - joint.lower) / 2 : 1;
      reach = std::max(reach, swept * bound.reach()[static_cast<std::size_t>(j)]);
    }
  }
  if (reach == 0) return 0.02;
  return std::clamp(std::floor(reach / 50 * 1000) / 1000, 0.001, 0.02);
}

// "1 joint", "2 joints"
std::string Count(std::size_t number, const std::string& noun) {
  return fmt::format("{} {}{}", number, noun, number == 1 ? "" : "s");
}

class RobotMaker {
 public:
  RobotMaker(const MakeRobotFlags& flags, const SayLine& say) : flags_(flags), say_(say) {}

  void Make() {
    RequireFolder();
    ReadUrdf();
    ReadSrdf();
    MakeGroups();
    MakeSpheres();
    SayWhatIsOnlyDrawn();
    MakePairs();
    CheckStates();
    robot().edge_resolution_m = SuggestEdgeResolution(robot());
    Say("edges are proven free (certified); where they are sampled, nothing moves more than {} m "
        "between samples",
        robot().edge_resolution_m);
    Say("planners follow their own rules for this robot: no settings files are needed");
    const MeshFiles meshes = FindRobotMeshes();
    RenameMeshesOfUrdf(meshes);
    WriteRobotFolder(draft_, flags_.out);
    CopyMeshes(meshes, flags_.out);
    LoadRobot(flags_.out);  // What was written must be what it is meant to be.
    Say("written: {}", (flags_.out / "robot.yaml").string());
  }

 private:
  Robot& robot() { return draft_.robot; }
  const std::string& LinkName(int link) {
    return robot().model.links()[static_cast<std::size_t>(link)].name;
  }
  std::string PairName(const std::pair<int, int>& pair) {
    return LinkName(pair.first) + " and " + LinkName(pair.second);
  }
  template <typename... Values>
  void Say(fmt::format_string<Values...> format, Values&&... values) {
    say_(fmt::format(format, std::forward<Values>(values)...));
  }
  void Say(const std::string& line) { say_(line); }
  void SayAll(const std::vector<std::string>& lines) {
    for (const std::string& line : lines) Say(line);
  }

  void RequireFolder() const {
    std::error_code error;
    if (fs::exists(flags_.out, error) && !fs::is_directory(flags_.out, error)) {
      throw InputError(fmt::format("--out {}: is a file; name a folder", flags_.out.string()));
    }
    if (fs::exists(flags_.out / "robot.yaml", error) && !flags_.replace) {
      throw InputError(fmt::format("{} holds a robot already; name another folder, or --replace",
                                   flags_.out.string()));
    }
  }

  void ReadUrdf() {
    draft_.urdf_text = ReadText(flags_.urdf);
    draft_.origin = flags_.urdf.filename().string();
    if (!flags_.srdf.empty()) draft_.origin += " and " + flags_.srdf.filename().string();
    std::vector<std::string> warnings;
    robot().model = RobotModel::FromUrdf(draft_.urdf_text, flags_.urdf.string(), &warnings);
    robot().name = flags_.name.empty() ? robot().model.name() : flags_.name;
    static const std::regex kName("[A-Za-z0-9_][A-Za-z0-9_.-]*");
    if (!std::regex_match(robot().name, kName)) {
      throw InputError(fmt::format(
          "the robot's name '{}' cannot name a file; give another with --name", robot().name));
    }
    SayAll(warnings);
    robot().resources = {fs::absolute(flags_.urdf).parent_path(),
                         ParsePackagePaths(flags_.package_paths)};
    std::size_t moving = 0;
    std::vector<std::string> followers;
    for (const Joint& joint : robot().model.joints()) {
      if (joint.type == JointType::kFixed) continue;
      ++moving;
      if (joint.leader >= 0) followers.push_back(joint.name);
    }
    Say("robot '{}': {}, {} not fixed", robot().name, Count(robot().model.links().size(), "link"),
        Count(moving, "joint"));
    if (!followers.empty()) Say("  they follow another: {}", fmt::join(followers, ", "));
  }

  void ReadSrdf() {
    if (flags_.srdf.empty()) return;
    srdf_ = ParseSrdf(ReadText(flags_.srdf), flags_.srdf.string(), robot().model);
    if (srdf_->groups.empty()) {
      throw InputError(fmt::format("{}; groups are proposed without --srdf{}",
                                   NoGroupFault(*srdf_, flags_.srdf.string()),
                                   srdf_->spheres.empty() ? "" : ": give it by --spheres instead"));
    }
    SayAll(srdf_->warnings);
  }

  void MakeGroups() {
    std::vector<std::string> left_out;
    if (srdf_) {
      robot().groups = srdf_->groups;
      robot().virtual_joints = srdf_->virtual_joints;
    } else {
      robot().groups = ProposeGroups(robot().model, &left_out);
    }
    Say("groups, {}:", srdf_ ? "from the SRDF" : "proposed from the tree of joints");
    std::set<int> planned;
    for (const PlanningGroup& group : robot().groups) {
      std::vector<std::string> tips;
      for (const int tip : group.tips()) tips.push_back(LinkName(tip));
      std::vector<std::string> states;
      for (const auto& [name, q] : group.states) states.push_back(name);
      planned.insert(group.joints.begin(), group.joints.end());
      Say("  {}: {}, {} {}{}{}", group.name, Count(group.joints.size(), "joint"),
          tips.size() == 1 ? "tip" : "tips", fmt::join(tips, ", "),
          states.empty() ? "" : "; states ", fmt::join(states, ", "));
    }
    for (const std::string& line : left_out) Say("  {}", line);
    if (srdf_) {
      for (const std::string& line : srdf_->group_warnings) Say("  {}", line);
      for (const std::string& line : srdf_->left_out) Say("  {}", line);
      for (const Srdf::EndEffector& effector : srdf_->end_effectors) {
        Say("  end effector '{}' on {}", effector.name, effector.parent_link);
      }
      for (const VirtualJoint& joint : srdf_->virtual_joints) {
        const bool is_fixed = joint.type == JointType::kFixed;
        Say("  {} stands {} {} by the {} joint '{}'{}", LinkName(joint.child_link),
            is_fixed ? "at" : "in", joint.parent_frame, EnumName(joint.type), joint.name,
            is_fixed ? "" : ": problems may give its pose");
      }
    }
    std::vector<std::string> held;
    const std::vector<Joint>& joints = robot().model.joints();
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const bool own = joints[j].type != JointType::kFixed && joints[j].leader < 0;
      if (own && !planned.contains(static_cast<int>(j))) held.push_back(joints[j].name);
    }
    if (!held.empty()) {
      Say("  in no group, held where problems say: {}", fmt::join(held, ", "));
    }
  }

  void MakeSpheres() {
    if (flags_.without_spheres) {
      LoadLinkShapes(robot().model, robot().resources, say_);
      Say("spheres: none, as asked; the robot can be used with --collision-model meshes only");
      return;
    }
    if (!flags_.spheres.empty()) {
      std::vector<std::string> warnings;
      std::vector<LinkSphere> spheres =
          ReadLinkSpheres(flags_.spheres, ReadText(flags_.spheres), robot().model, &warnings);
      SayAll(warnings);
      TakeSpheres(std::move(spheres), "from " + flags_.spheres.filename().string());
    } else {
      if (srdf_) SayAll(srdf_->sphere_warnings);
      if (srdf_ && !srdf_->spheres.empty()) {
        TakeSpheres(srdf_->spheres, "the SRDF's approximations");
      } else {
        EncloseUrdf();
      }
    }
    if (robot().spheres.empty()) {
      throw InputError(
          fmt::format("{}: no link has collision geometry; give a sphere model with --spheres FILE",
                      flags_.urdf.string()));
    }
  }

  // The URDF's geometry is not what they are made of, but the robot's all the same. What is missing
  // of it is told where it would be copied.
  void TakeSpheres(std::vector<LinkSphere> spheres, const std::string& origin) {
    RemarkSizes(robot().model, robot().resources, say_);
    robot().spheres = std::move(spheres);
    SayWhatSpheresLeave(origin);
  }

  void SayWhatSpheresLeave(const std::string& origin) {
    std::set<int> links;
    for (const LinkSphere& sphere : robot().spheres) links.insert(sphere.link);
    Say("spheres: {} on {}, {}", robot().spheres.size(), Count(links.size(), "link"), origin);
    for (int link = 0; link < robot().model.num_links(); ++link) {
      const Link& description = robot().model.links()[static_cast<std::size_t>(link)];
      if (!description.collision.empty() && !links.contains(link)) {
        draft_.links_without_spheres.push_back(description.name);
      }
    }
    if (draft_.links_without_spheres.empty()) return;
    Say("  without, though they have a body in the URDF, so that they are not checked: {}",
        fmt::join(draft_.links_without_spheres, ", "));
  }

  // Nothing else would tell that such a link goes through everything.
  void SayWhatIsOnlyDrawn() {
    std::vector<std::string> names = LinksDrawnOnly(draft_.urdf_text);
    std::erase_if(names, [&](const std::string& name) {
      const int link = robot().model.FindLink(name);
      return link < 0 || HasBody(link);  // By spheres of another file.
    });
    if (names.empty()) return;
    Say("  drawn (<visual>) without collision geometry, so that nothing is checked against them: "
        "{}",
        fmt::join(names, ", "));
  }

  static std::vector<OuterSet> Fit(const std::vector<LinkBody>& bodies, const FitGoal& goal) {
    ProgressLine progress(static_cast<int>(bodies.size()), 0, /*pieces_are_alike=*/false);
    return FitOuterSpheres(bodies, goal,
                           [&](int done, const std::string& text) { progress.Show(done, text); });
  }

  void EncloseUrdf() {
    const LinkBodies links = ReadLinkBodies(robot().model, robot().resources, say_);
    FitGoal goal;
    goal.protrusion_m = flags_.protrusion_m;
    goal.most_a_link = kMostSpheresOfALink;
    std::vector<std::vector<Ball>> sets;
    double protrusion_m = 0;
    std::string worst;
    const std::vector<OuterSet> fitted = Fit(links.bodies, goal);
    for (std::size_t i = 0; i < fitted.size(); ++i) {
      sets.push_back(fitted[i].balls);
      if (links.bodies[i].has_solids()) fitted_.insert(links.links[i]);
      const double here = GreatestProtrusion(links.bodies[i], sets.back());
      if (here <= protrusion_m) continue;
      protrusion_m = here;
      worst = LinkName(links.links[i]);
    }
    robot().spheres = ToLinkSpheres(links, sets);
    SayWhatSpheresLeave("the URDF's collision geometry");
    if (fitted_.empty()) return;
    Say("  they enclose the meshes, boxes and cylinders of {}, and reach up to {:.3f} m beyond "
        "them "
        "(at {})",
        Count(fitted_.size(), "link"), protrusion_m, worst);
    if (protrusion_m > flags_.protrusion_m) {
      Say("  that is further than --protrusion {}: no link gets more than {} spheres",
          flags_.protrusion_m, kMostSpheresOfALink);
    }
  }

  void MakePairs() {
    const bool are_known = srdf_ && !srdf_->disabled_pairs.empty();
    if (are_known) {
      Say("pairs: {} are not checked, as the SRDF says", srdf_->disabled_pairs.size());
      Exempt("disabled by the SRDF", srdf_->disabled_pairs);
    }
    if (srdf_) {
      std::ranges::copy_if(
          srdf_->checked_pairs, std::back_inserter(robot().checked_pairs),
          [&](const auto& pair) { return HasBody(pair.first) && HasBody(pair.second); });
    }
    if (robot().spheres.empty()) {
      SayWhatIsChecked();
      return;
    }
    const PairSamples samples = Sample(JointsToDraw(robot().model), flags_.samples);
    const std::string drawn = fmt::format("{} random configurations of all joints{}",
                                          samples.samples, PosedJoints().empty() ? "" : kButPosed);
    if (!are_known) ExemptNever(samples, drawn);
    SayWhatMayBeAnywhere(samples);
    ExemptOverlaps(samples.Always(), "in contact in nearly all of " + drawn);
    ExemptOverlaps(HeldTogether(),
                   "in contact by default, and moved one against the other by no group");
    SayWhatIsChecked();
    for (const PlanningGroup& group : robot().groups) SayHowFree(group);
  }

  // Never to have met in samples is no more than a reason to look closer: a narrow way to contact
  // is easily missed. What is found to meet, or nearly, stays checked.
  void ExemptNever(const PairSamples& samples, const std::string& drawn) {
    LinkPairs apart;
    LinkPairs found;
    for (const auto& pair : NotEnabled(samples.Never())) {
      const bool meet = FindContact(robot(), pair.first, pair.second, flags_.seed);
      (meet ? found : apart).push_back(pair);
    }
    const std::string reason = fmt::format(
        "met in none of {}, nor were brought within {:g} mm of each other by descents on their "
        "distance",
        drawn, 1e3 * kContactGap);
    Say("pairs: {} of {} {}, and are not checked", apart.size(), samples.pairs.size(), reason);
    if (!found.empty()) {
      Say("  {} more met in no random configuration, but were brought within {:g} mm by descents, "
          "and are checked: {}",
          found.size(), 1e3 * kContactGap, FirstNames(found));
    }
    Exempt(reason, apart);
  }

  std::vector<std::string> PosedJoints() {
    std::vector<std::string> names;
    for (const Joint& joint : robot().model.joints()) {
      if (NumPositions(joint.type) > 1) names.push_back(joint.name);
    }
    return names;
  }

  void SayWhatMayBeAnywhere(const PairSamples& samples) {
    const LinkPairs pairs = samples.Anywhere();
    if (pairs.empty()) return;
    Say("  {} checked, whatever was sampled, as planar and floating joints between the links stand "
        "where problems say ({})",
        Count(pairs.size(), "pair"), fmt::join(PosedJoints(), ", "));
  }

  PairSamples Sample(const std::vector<int>& joints, int samples) {
    return SamplePairs(robot(), {joints, samples, flags_.seed});
  }

  bool HasBody(int link) {
    const auto is_on_it = [link](const LinkSphere& sphere) { return sphere.link == link; };
    return !robot().model.links()[static_cast<std::size_t>(link)].collision.empty() ||
           std::ranges::any_of(robot().spheres, is_on_it);
  }

  bool IsEnabled(const std::pair<int, int>& pair) const {
    return srdf_ && std::ranges::find(srdf_->enabled_pairs, pair) != srdf_->enabled_pairs.end();
  }
  LinkPairs NotEnabled(LinkPairs pairs) const {
    std::erase_if(pairs, [&](const auto& pair) { return IsEnabled(pair); });
    return pairs;
  }

  std::string PairNames(const LinkPairs& pairs) {
    std::vector<std::string> names;
    for (const auto& pair : pairs) names.push_back(PairName(pair));
    return fmt::format("{}", fmt::join(names, "; "));
  }

  std::string FirstNames(const LinkPairs& pairs) {
    if (pairs.size() <= kWorstPairs) return PairNames(pairs);
    const auto end = pairs.begin() + static_cast<std::ptrdiff_t>(kWorstPairs);
    return fmt::format("{}; and {} more", PairNames({pairs.begin(), end}),
                       pairs.size() - kWorstPairs);
  }

  void SayWhatIsChecked() {
    if (!robot().checked_pairs.empty()) {
      Say("  checked, though a joint connects them, as the SRDF does not disable them: {}",
          PairNames(robot().checked_pairs));
    }
    if (!enabled_overlaps_.empty()) {
      Say("  checked, though in contact in nearly all configurations, as the SRDF enables them: {}",
          PairNames({enabled_overlaps_.begin(), enabled_overlaps_.end()}));
    }
  }

  void Exempt(const std::string& reason, const LinkPairs& pairs) {
    robot().allowed_pairs.insert(robot().allowed_pairs.end(), pairs.begin(), pairs.end());
    std::erase_if(robot().checked_pairs,
                  [&](const auto& pair) { return std::ranges::find(pairs, pair) != pairs.end(); });
    draft_.exempt.push_back({reason, pairs});
  }

  void ExemptOverlaps(const LinkPairs& overlaps, const std::string& reason) {
    const LinkPairs pairs = NotEnabled(overlaps);
    for (const auto& pair : overlaps) {
      if (IsEnabled(pair)) enabled_overlaps_.insert(pair);
    }
    if (pairs.empty()) return;
    Say("  {}, so that they are not checked either: {}", reason, PairNames(pairs));
    Exempt(reason, pairs);
  }

  // Closed fingers, bellows that a lift would draw out: whatever is planned, they touch where
  // problems leave the joints between them at their defaults, and else it is the same all along a
  // path. What a group moves is another matter: it may be met at every other held position.
  LinkPairs HeldTogether() {
    LinkPairs pairs = PairsInContact(robot(), robot().model.DefaultPositions());
    std::erase_if(pairs, [&](const auto& pair) {
      return AnywhereByPose(robot().model, pair.first, pair.second) ||
             std::ranges::any_of(robot().groups, [&](const PlanningGroup& group) {
               return JointsMove(robot().model, group.joints, pair.first, pair.second);
             });
    });
    return pairs;
  }

  // As a planner meets them: other joints are held.
  void SayHowFree(const PlanningGroup& group) {
    const PairSamples samples = Sample(group.joints, kGroupSamples);
    Say("  {}: {} of {} random configurations are free of self-collision", group.name, samples.free,
        samples.samples);
    const LinkPairs held = samples.HeldInContact();
    if (!held.empty()) {
      Say("    the group does not move these, which touch as other joints stand by default: {}; "
          "give those another position in the problems, or, if they are to touch, name them in "
          "allowed_pairs; without these pairs {} of {} are free",
          FirstNames(held), samples.free_if_moved, samples.samples);
    }
    if (2 * samples.free_if_moved > samples.samples) return;
    std::vector<std::string> worst;
    bool is_fitted = false;
    for (const PairSamples::Pair& pair : samples.MostOften(kWorstPairs)) {
      is_fitted = is_fitted || fitted_.contains(pair.link_a) || fitted_.contains(pair.link_b);
      worst.push_back(fmt::format("{} ({:.0f} %)", PairName({pair.link_a, pair.link_b}),
                                  100.0 * pair.contacts / samples.samples));
    }
    Say("    most often in contact: {}; what overlaps by construction belongs in allowed_pairs of "
        "robot.yaml{}",
        fmt::join(worst, "; "),
        is_fitted ? ", and a smaller --protrusion makes closer spheres" : "");
  }

  void CheckStates() {
    for (const PlanningGroup& group : robot().groups) {
      for (const auto& [name, q] : group.states) {
        std::vector<double> full = robot().model.DefaultPositions();
        for (std::size_t j = 0; j < group.joints.size(); ++j) {
          const Joint& joint = robot().model.joints()[static_cast<std::size_t>(group.joints[j])];
          full[static_cast<std::size_t>(joint.position_index)] = q[j];
        }
        if (robot().spheres.empty()) continue;
        LinkPairs touching = PairsInContact(robot(), full);
        // The others are no matter of the state; SayHowFree has told them.
        std::erase_if(touching, [&](const auto& pair) {
          return !JointsMove(robot().model, group.joints, pair.first, pair.second);
        });
        if (touching.empty()) continue;
        Say("  state '{}' of {} is in collision with itself: {}", name, group.name,
            PairName(touching.front()));
      }
    }
  }

  MeshFiles FindRobotMeshes() {
    MeshFiles meshes = FindMeshes(robot().model, robot().resources, flags_.out);
    if (!meshes.files.empty()) Say("{} copied", Count(meshes.files.size(), "mesh file"));
    for (const auto& [uri, name] : meshes.renamed) Say("  {} is {} in the URDF here", uri, name);
    if (meshes.missing.empty()) return meshes;
    if (robot().spheres.empty()) throw InputError(meshes.missing.front());
    Say("{} missing, so that --collision-model meshes cannot be used: {}",
        Count(meshes.missing.size(), "mesh file"), meshes.missing.front());
    return meshes;
  }

  void RenameMeshesOfUrdf(const MeshFiles& meshes) {
    const fs::path target = UrdfPath(draft_, flags_.out);
    std::error_code error;
    if (!meshes.renamed.empty() && fs::equivalent(target, flags_.urdf, error)) {
      throw InputError(fmt::format("{}: would be written over, with {} for {}; name another --out",
                                   target.string(), meshes.renamed.begin()->second,
                                   meshes.renamed.begin()->first));
    }
    draft_.urdf_text = RenameMeshes(draft_.urdf_text, meshes.renamed);
  }

  const MakeRobotFlags& flags_;
  const SayLine& say_;
  RobotDraft draft_;
  std::optional<Srdf> srdf_;
  std::set<int> fitted_;  // Links whose meshes, boxes and cylinders spheres were made to enclose.
  std::set<std::pair<int, int>> enabled_overlaps_;
};

}  // namespace

void MakeRobotFlags::AddTo(CLI::App* app) {
  app->add_option("--urdf", urdf, "the robot's URDF, expanded from xacro")->required();
  app->add_option("--srdf", srdf,
                  "its SRDF: groups, states, disabled pairs; default: groups are proposed from the "
                  "joints and pairs sampled and searched for contact");
  app->add_option(
      "--spheres", spheres,
      "sphere model: a URDF of spheres, an SRDF with approximations, or a spheres.yaml; "
      "default: the SRDF's, else those that enclose the URDF's collision geometry");
  app->add_option("--out", out, "folder to write")->required();
  app->add_option("--name", name, "name of the robot; default: the URDF's");
  app->add_option("--package-path", package_paths, "NAME=DIR, for package:// URIs of meshes");
  app->add_option("--samples", samples, "random configurations for the pairs")
      ->check(CLI::Range(100, 10'000'000))
      ->capture_default_str();
  app->add_option("--seed", seed, "of these configurations")
      ->check(AnySeed())
      ->capture_default_str();
  app->add_option(
         "--protrusion", protrusion_m,
         "how far spheres may reach beyond the meshes, boxes and cylinders they enclose, m")
      ->check(Positive())
      ->capture_default_str();
  app->add_flag("--without-spheres", without_spheres,
                "for a robot that is checked with its meshes alone");
  app->add_flag("--replace", replace, "write over a robot that the folder holds");
}

void MakeRobot(const MakeRobotFlags& flags, const SayLine& say) { RobotMaker(flags, say).Make(); }

}  // namespace planbench
