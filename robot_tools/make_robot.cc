#include "robot_tools/make_robot.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <regex>
#include <set>

#include "common/command_line.h"
#include "common/error.h"
#include "common/read_text.h"
#include "robot_model/group_kinematics.h"
#include "robot_model/link_spheres.h"
#include "robot_model/motion_bound.h"
#include "robot_model/robot_folder.h"
#include "robot_model/srdf.h"
#include "robot_tools/group_proposal.h"
#include "robot_tools/link_bodies.h"
#include "robot_tools/mesh_files.h"
#include "robot_tools/pair_sampling.h"
#include "robot_tools/robot_writer.h"
#include "sphere_fitting/outer_spheres.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;
using LinkPairs = std::vector<std::pair<int, int>>;

constexpr int kMostSpheresOfALink = 100;
constexpr int kFreeSamples = 1000;

// A fiftieth of how far the robot reaches, in mm, and no more than arms of a metre need.
double SuggestEdgeResolution(const Robot& robot) {
  double reach = 0;
  for (const PlanningGroup& group : robot.groups) {
    const MotionBound bound(robot.model, group, robot.model.DefaultPositions(), robot.spheres);
    for (int j = 0; j < group.space.size(); ++j) {
      if (group.space.joint(j).prismatic) continue;
      reach = std::max(reach, bound.reach()[static_cast<std::size_t>(j)]);
    }
  }
  if (reach == 0) return 0.02;
  return std::clamp(std::floor(reach / 50 * 1000) / 1000, 0.001, 0.02);
}

class RobotMaker {
 public:
  explicit RobotMaker(const MakeRobotFlags& flags) : flags_(flags) {}

  std::vector<std::string> Make() {
    RequireFolder();
    ReadUrdf();
    if (!flags_.srdf.empty()) {
      srdf_ = ParseSrdf(ReadText(flags_.srdf), flags_.srdf.string(), robot().model);
      for (const std::string& warning : srdf_->warnings) Say(warning);
    }
    MakeGroups();
    MakeSpheres();
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
    return std::move(report_);
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
    report_.push_back(fmt::format(format, std::forward<Values>(values)...));
  }
  void Say(const std::string& line) { report_.push_back(line); }

  void RequireFolder() const {
    std::error_code error;
    if (fs::exists(flags_.out / "robot.yaml", error) && !flags_.replace) {
      throw InputError(fmt::format("{} holds a robot already; name another folder, or --replace",
                                   flags_.out.string()));
    }
  }

  void ReadUrdf() {
    draft_.urdf_text = ReadText(flags_.urdf);
    draft_.origin = flags_.urdf.filename().string();
    if (!flags_.srdf.empty()) draft_.origin += " and " + flags_.srdf.filename().string();
    robot().model = RobotModel::FromUrdf(draft_.urdf_text, flags_.urdf.string(), &report_);
    robot().name = flags_.name.empty() ? robot().model.name() : flags_.name;
    static const std::regex kName("[A-Za-z0-9_][A-Za-z0-9_.-]*");
    if (!std::regex_match(robot().name, kName)) {
      throw InputError(fmt::format(
          "the robot's name '{}' cannot name a file; give another with --name", robot().name));
    }
    robot().resources = {fs::absolute(flags_.urdf).parent_path(), {}};
    for (const std::string& argument : flags_.package_paths) {
      robot().resources.packages.insert(ParsePackagePath(argument));
    }
    int moving = 0;
    std::vector<std::string> followers;
    for (const Joint& joint : robot().model.joints()) {
      if (joint.type == JointType::kFixed) continue;
      ++moving;
      if (joint.leader >= 0) followers.push_back(joint.name);
    }
    Say("robot '{}': {} links, {} joints that are not fixed", robot().name,
        robot().model.num_links(), moving);
    if (!followers.empty()) Say("  they follow another: {}", fmt::join(followers, ", "));
  }

  void MakeGroups() {
    if (srdf_) {
      if (srdf_->groups.empty()) {
        throw InputError(NoGroupFault(*srdf_, flags_.srdf.string()));
      }
      robot().groups = srdf_->groups;
      robot().virtual_joints = srdf_->virtual_joints;
    } else {
      robot().groups = ProposeGroups(robot().model);
    }
    Say("groups, {}:", srdf_ ? "from the SRDF" : "proposed from the tree of joints");
    std::set<int> planned;
    for (const PlanningGroup& group : robot().groups) {
      std::vector<std::string> tips;
      for (const int tip : group.tips()) tips.push_back(LinkName(tip));
      std::vector<std::string> states;
      for (const auto& [name, q] : group.states) states.push_back(name);
      planned.insert(group.joints.begin(), group.joints.end());
      Say("  {}: {} joints, tip {}{}{}", group.name, group.space.size(), fmt::join(tips, ", "),
          states.empty() ? "" : "; states ", fmt::join(states, ", "));
    }
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
      Say("spheres: none, as asked; the robot can be used with --collision-model meshes only");
      return;
    }
    if (!flags_.spheres.empty()) {
      robot().spheres = ReadLinkSpheres(flags_.spheres, ReadText(flags_.spheres), robot().model);
      SayWhatSpheresLeave("from " + flags_.spheres.filename().string());
    } else if (srdf_ && !srdf_->spheres.empty()) {
      robot().spheres = srdf_->spheres;
      SayWhatSpheresLeave("the SRDF's approximations");
    } else {
      EncloseUrdf();
    }
    if (robot().spheres.empty()) {
      throw InputError(
          fmt::format("{}: no link has collision geometry; give a sphere model with --spheres FILE",
                      flags_.urdf.string()));
    }
  }

  void SayWhatSpheresLeave(const std::string& origin) {
    std::set<int> links;
    for (const LinkSphere& sphere : robot().spheres) links.insert(sphere.link);
    Say("spheres: {} on {} links, {}", robot().spheres.size(), links.size(), origin);
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

  void EncloseUrdf() {
    const LinkBodies links = ReadLinkBodies(robot().model, robot().resources);
    for (const std::string& remark : links.remarks) Say(remark);
    FitGoal goal;
    goal.protrusion_m = flags_.protrusion_m;
    goal.most_a_link = kMostSpheresOfALink;
    std::vector<std::vector<Ball>> sets;
    double protrusion_m = 0;
    std::string worst;
    int enclosed = 0;
    const std::vector<OuterSet> fitted = FitOuterSpheres(links.bodies, goal);
    for (std::size_t i = 0; i < fitted.size(); ++i) {
      sets.push_back(fitted[i].balls);
      if (links.bodies[i].has_solids()) ++enclosed;
      const double here = GreatestProtrusion(links.bodies[i], sets.back());
      if (here <= protrusion_m) continue;
      protrusion_m = here;
      worst = LinkName(links.links[i]);
    }
    robot().spheres = ToLinkSpheres(links, sets);
    SayWhatSpheresLeave("the URDF's collision geometry");
    if (enclosed == 0) return;
    Say("  they enclose the meshes, boxes and cylinders of {} links, and reach up to {:.3f} m "
        "beyond "
        "them (at {})",
        enclosed, protrusion_m, worst);
  }

  void MakePairs() {
    if (srdf_ && !srdf_->disabled_pairs.empty()) {
      draft_.exempt.push_back({"disabled by the SRDF", srdf_->disabled_pairs});
      Say("pairs: {} are not checked, as the SRDF says", srdf_->disabled_pairs.size());
    }
    if (robot().spheres.empty()) return;
    const PairSamples samples =
        SamplePairs(robot().model, robot().spheres, flags_.samples, flags_.seed);
    if (draft_.exempt.empty()) {
      draft_.exempt.push_back(
          {fmt::format("met in none of {} random configurations", samples.samples),
           samples.Never()});
      Say("pairs: {} of {} met in none of {} random configurations of all joints (with 95 % "
          "confidence they meet in fewer than one of {}), and are not checked",
          samples.Never().size(), samples.pairs.size(), samples.samples,
          std::max(1, samples.samples / 3));
    }
    LinkPairs always = samples.Always();
    const LinkPairs& known = draft_.exempt.front().pairs;
    std::erase_if(always, [&](const std::pair<int, int>& pair) {
      return std::find(known.begin(), known.end(), pair) != known.end();
    });
    if (!always.empty()) {
      std::vector<std::string> names;
      for (const auto& pair : always) names.push_back(PairName(pair));
      Say("  in contact in nearly all of {} random configurations, so that they are not checked "
          "either: {}",
          samples.samples, fmt::join(names, "; "));
    }
    draft_.exempt.push_back({"overlap by construction", std::move(always)});
    for (const RobotDraft::ExemptPairs& exempt : draft_.exempt) {
      robot().allowed_pairs.insert(robot().allowed_pairs.end(), exempt.pairs.begin(),
                                   exempt.pairs.end());
    }
    ExemptHeldContacts();
    const double share =
        FreeShare(robot().model, robot().spheres, robot().allowed_pairs, kFreeSamples, flags_.seed);
    Say("  {:.0f} % of {} random configurations are free of self-collision", 100 * share,
        kFreeSamples);
  }

  // Fingers that are closed by default: no group could ever plan.
  void ExemptHeldContacts() {
    const std::vector<double> positions = robot().model.DefaultPositions();
    LinkPairs held =
        PairsInContact(robot().model, robot().spheres, robot().allowed_pairs, positions);
    for (const PlanningGroup& group : robot().groups) {
      const GroupKinematics kinematics(robot().model, group, positions);
      std::erase_if(held, [&](const std::pair<int, int>& pair) {
        return kinematics.MoveRelatively(pair.first, pair.second);
      });
    }
    if (held.empty()) return;
    std::vector<std::string> names;
    for (const auto& pair : held) names.push_back(PairName(pair));
    Say("  in contact by default, and moved apart by no group, so that they are not checked "
        "either: "
        "{}",
        fmt::join(names, "; "));
    robot().allowed_pairs.insert(robot().allowed_pairs.end(), held.begin(), held.end());
    draft_.exempt.push_back({"touch by default, moved apart by no group", std::move(held)});
  }

  void CheckStates() {
    for (const PlanningGroup& group : robot().groups) {
      for (const auto& [name, q] : group.states) {
        std::vector<double> full = robot().model.DefaultPositions();
        for (std::size_t j = 0; j < group.joints.size(); ++j) {
          const Joint& joint = robot().model.joints()[static_cast<std::size_t>(group.joints[j])];
          full[static_cast<std::size_t>(joint.position_index)] = q[j];
          if (q[j] < joint.lower - JointSpace::kLimitTolerance ||
              q[j] > joint.upper + JointSpace::kLimitTolerance) {
            Say("  state '{}' of {} is out of the limits: {} at {}", name, group.name, joint.name,
                q[j]);
          }
        }
        if (robot().spheres.empty()) continue;
        const LinkPairs touching =
            PairsInContact(robot().model, robot().spheres, robot().allowed_pairs, full);
        if (touching.empty()) continue;
        Say("  state '{}' of {} is in collision with itself: {}", name, group.name,
            PairName(touching.front()));
      }
    }
  }

  MeshFiles FindRobotMeshes() {
    MeshFiles meshes = FindMeshes(robot().model, robot().resources, flags_.out);
    if (!meshes.files.empty()) Say("{} mesh files copied", meshes.files.size());
    for (const auto& [uri, name] : meshes.renamed) Say("  {} is {} in the URDF here", uri, name);
    if (meshes.missing.empty()) return meshes;
    if (robot().spheres.empty()) throw InputError(meshes.missing.front());
    Say("{} meshes are missing, so that --collision-model meshes cannot be used: {}",
        meshes.missing.size(), meshes.missing.front());
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
  RobotDraft draft_;
  std::optional<Srdf> srdf_;
  std::vector<std::string> report_;
};

}  // namespace

void MakeRobotFlags::AddTo(CLI::App* app) {
  app->add_option("--urdf", urdf, "the robot's URDF, expanded from xacro")->required();
  app->add_option("--srdf", srdf,
                  "its SRDF: groups, states, disabled pairs; default: groups are proposed from the "
                  "joints and pairs sampled");
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

std::vector<std::string> MakeRobot(const MakeRobotFlags& flags) { return RobotMaker(flags).Make(); }

}  // namespace planbench
