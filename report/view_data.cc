#include "report/view_data.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "collision/model_spheres.h"
#include "common/error.h"
#include "common/lookup.h"
#include "planning/resolve.h"
#include "report/shape_json.h"
#include "robot_model/group_kinematics.h"

namespace planbench {
namespace {

/// Without a path; more would hide one another.
constexpr std::size_t kGoalsShown = 8;

/// "valid", or why a path is not.
std::string Told(const PathVerdict& verdict) {
  if (verdict.valid) return "valid";
  return verdict.contact ? Describe(*verdict.contact) : verdict.reason;
}

/// What is said of a path: the referee's verdict and, if they judged it too, that of the meshes.
Json Remarks(const PathCheckReplyMessage& check) {
  Json remarks = Json::array();
  if (check.verdict) remarks.push_back("the referee: " + Told(*check.verdict));
  if (check.mesh_verdict) remarks.push_back("the meshes: " + Told(*check.mesh_verdict));
  return remarks;
}

/// Of verdicts that say where on a path it is not valid, the referee's before that of the meshes;
/// null without any.
const PathVerdict* Hit(const PathCheckReplyMessage& check) {
  for (const auto* verdict : {&check.verdict, &check.mesh_verdict}) {
    if (*verdict && !(*verdict)->valid && (*verdict)->segment >= 0) return &**verdict;
  }
  return nullptr;
}

/// A robot in a scene, moved by one group.
class View {
 public:
  View(const ShownRobot& shown, const ShownScene& shown_scene, const std::string& group_name,
       const JointState& start, const std::vector<JointGoal>& goal, CollisionModel model)
      : robot_(shown.robot()),
        group_(robot_.Group(group_name)),
        query_(ResolveQuery(robot_, group_, start, goal, "the problem")),
        kinematics_(robot_.model, group_, query_.base_positions),
        notes_(shown_scene.remarks()) {
    const Scene& scene = shown_scene.scene();
    json_["meshes"] = Json::object();
    ChooseGeometry(shown, model);
    json_["solids"] = Json::array();
    for (const SceneObject& object : scene.objects) AddSolids(object, "");
    for (const AttachedObject& attached : scene.attached) {
      AddSolids(attached.object, attached.link);
    }
    json_["links"] = Json::array();
    kinematics_.Update(query_.start);
    for (int link = 0; link < robot_.model.num_links(); ++link) {
      if (!IsShown(link, scene)) continue;
      Json one = {{"name", robot_.model.links()[static_cast<std::size_t>(link)].name},
                  {"pose", PoseJson(kinematics_.X_BL(link))},
                  {"moves", kinematics_.Moves(link)},
                  {"spheres", Json::array()}};
      for (const LinkSphere& sphere : spheres_) {
        if (sphere.link != link) continue;
        Json values = PointJson(sphere.p_LS);
        values.push_back(RoundedPosition(sphere.radius));
        one["spheres"].push_back(std::move(values));
      }
      one["shapes"] = Lookup(bodies_, link).value_or(Json::array());
      json_["links"].push_back(std::move(one));
      if (kinematics_.Moves(link)) moving_.push_back(link);
    }
    json_["motions"] = Json::array();
  }

  /// Why a path of such joints cannot be shown; "" if it can.
  std::string WhyNotShown(const std::vector<std::string>& joint_names) const {
    for (const JointSpace::Joint& joint : group_.space.joints()) {
      if (std::find(joint_names.begin(), joint_names.end(), joint.name) != joint_names.end()) {
        continue;
      }
      return fmt::format("it has no joint '{}' of group {}", joint.name, group_.name);
    }
    return "";
  }

  /// Joints of the path by name, those of the group among them.
  void AddMotion(const std::string& name, const Path& path,
                 const std::vector<std::string>& joint_names, const PathCheckReplyMessage& check,
                 int num_frames) {
    if (path.empty()) return;
    const Path waypoints = InGroupOrder(path, joint_names);
    double length = 0;
    for (std::size_t i = 1; i < waypoints.size(); ++i) {
      length += group_.space.Distance(waypoints[i - 1], waypoints[i]);
    }
    Json motion = {{"name", name}, {"remarks", Remarks(check)}, {"frames", Json::array()}};
    const std::vector<int> tips = group_.tips();
    motion["tips"] = std::vector<Json>(tips.size(), Json::array());
    const auto add_frame = [&](const Configuration& q) {
      motion["frames"].push_back(Poses(q));
      for (std::size_t i = 0; i < tips.size(); ++i) {
        motion["tips"][i].push_back(PointJson(kinematics_.X_BL(tips[i]).translation()));
      }
    };
    const PathVerdict* const hit = Hit(check);
    add_frame(waypoints.front());
    if (hit != nullptr && waypoints.size() == 1) motion["collision"] = 0;
    for (std::size_t i = 1; i < waypoints.size(); ++i) {
      const Configuration& from = waypoints[i - 1];
      const Configuration& to = waypoints[i];
      const double share = length > 0 ? group_.space.Distance(from, to) / length : 0;
      const int num_steps = std::max(1, static_cast<int>(std::ceil(num_frames * share)));
      Configuration q(from.size());
      for (int step = 1; step <= num_steps; ++step) {
        const double fraction = static_cast<double>(step) / num_steps;
        // The frame of a collision stands where the referee found it, not a step beside it.
        if (hit != nullptr && hit->segment == static_cast<int>(i) - 1 &&
            !motion.contains("collision") && hit->fraction <= fraction) {
          group_.space.Interpolate(from, to, hit->fraction, q);
          motion["collision"] = motion["frames"].size();
          add_frame(q);
        }
        group_.space.Interpolate(from, to, fraction, q);
        add_frame(q);
      }
    }
    json_["motions"].push_back(std::move(motion));
  }

  /// That of the goal's alternatives in which `path` ends, or which is nearest to its end; of an
  /// empty path the first kGoalsShown of them.
  void AddGoals(const Path& path, const std::vector<std::string>& joint_names) {
    const std::size_t num_goals = query_.goals.size();
    std::size_t first = 0;
    std::size_t num_shown = std::min(num_goals, kGoalsShown);
    if (!path.empty()) {
      first = NearestGoal(InGroupOrder({path.back()}, joint_names).front());
      num_shown = 1;
    }
    for (std::size_t i = first; i < first + num_shown; ++i) {
      json_["goals"].push_back(Poses(query_.goals[i].nominal));
    }
    if (num_shown < num_goals) {
      notes_.push_back(
          path.empty() ? fmt::format("{} of {} goals are shown.", num_shown, num_goals)
                       : fmt::format("Of {} goals the one at the path's end is shown.", num_goals));
    }
  }

  Json Take(const std::string& title, std::vector<std::string> facts) {
    facts.insert(facts.end(), notes_.begin(), notes_.end());
    json_["title"] = title;
    json_["facts"] = std::move(facts);
    return std::move(json_);
  }

 private:
  /// What the robot was, or is to be, checked by, or else what there is.
  void ChooseGeometry(const ShownRobot& shown, CollisionModel model) {
    spheres_ = ModelSpheres(robot_, model);
    if (model != CollisionModel::kMeshes && !spheres_.empty()) {
      if (model != CollisionModel::kEnclosing && !robot_.unchecked_links.empty()) {
        notes_.push_back(fmt::format("Neither checked nor shown, as they have no spheres: {}.",
                                     fmt::join(robot_.unchecked_links, ", ")));
      }
      return;
    }
    const ShownBodies& bodies = shown.bodies();
    if (bodies.why_not.empty()) {
      spheres_ = {};
      bodies_ = bodies.shapes;
      json_["meshes"] = bodies.meshes;
      notes_.insert(notes_.end(), bodies.remarks.begin(), bodies.remarks.end());
      if (model != CollisionModel::kMeshes) {
        notes_.push_back(
            fmt::format("The robot has no spheres for the collision model '{}'; shown: the "
                        "collision geometry of its URDF.",
                        EnumName(model)));
      }
      return;
    }
    const bool lacks_spheres = spheres_.empty() && model != CollisionModel::kMeshes;
    for (const auto* others : {&robot_.spheres, &robot_.enclosing_spheres}) {
      if (spheres_.empty()) spheres_ = *others;
    }
    if (spheres_.empty()) {
      notes_.push_back(
          fmt::format("The robot is not shown: it has no spheres, and {}.", bodies.why_not));
    } else {
      notes_.push_back(fmt::format(
          "The collision model is '{}'; shown: the robot's spheres, because {}{}.", EnumName(model),
          lacks_spheres ? "it has none for that model, and " : "", bodies.why_not));
    }
  }

  /// `link`: what the object is attached to; "" if it is of the scene.
  void AddSolids(const SceneObject& object, const std::string& link) {
    for (const PlacedShape& placed : object.shapes) {
      Json solid = {{"name", object.id}};
      if (!link.empty()) solid["link"] = link;
      solid["shape"] = ShapeJson(placed.shape, &json_["meshes"]);
      solid["pose"] = PoseJson(object.X_WO * placed.X_FS);
      json_["solids"].push_back(std::move(solid));
    }
  }

  bool IsShown(int link, const Scene& scene) const {
    const auto of_link = [&](const LinkSphere& sphere) { return sphere.link == link; };
    const auto at_link = [&](const AttachedObject& attached) {
      return robot_.model.FindLink(attached.link) == link;
    };
    return std::any_of(spheres_.begin(), spheres_.end(), of_link) || bodies_.contains(link) ||
           std::any_of(scene.attached.begin(), scene.attached.end(), at_link);
  }

  /// One that contains the configuration, before all others.
  std::size_t NearestGoal(const Configuration& q) const {
    const auto distance = [&](const GoalBox& goal) {
      return std::make_pair(!goal.Contains(group_.space, q),
                            group_.space.Distance(goal.nominal, q));
    };
    const auto nearest = std::min_element(
        query_.goals.begin(), query_.goals.end(),
        [&](const GoalBox& a, const GoalBox& b) { return distance(a) < distance(b); });
    return static_cast<std::size_t>(nearest - query_.goals.begin());
  }

  /// Of the links that move, in one list.
  Json Poses(const Configuration& q) {
    kinematics_.Update(q);
    Json poses = Json::array();
    for (const int link : moving_) AppendPose(kinematics_.X_BL(link), &poses);
    return poses;
  }

  Path InGroupOrder(const Path& path, const std::vector<std::string>& joint_names) const {
    std::vector<std::size_t> places;
    for (const JointSpace::Joint& joint : group_.space.joints()) {
      const auto found = std::find(joint_names.begin(), joint_names.end(), joint.name);
      places.push_back(static_cast<std::size_t>(found - joint_names.begin()));
    }
    Path ordered;
    for (const Configuration& q : path) {
      Configuration& waypoint = ordered.emplace_back();
      for (const std::size_t place : places) waypoint.push_back(q.at(place));
    }
    return ordered;
  }

  const Robot& robot_;
  const PlanningGroup& group_;
  ResolvedQuery query_;
  GroupKinematics kinematics_;
  std::span<const LinkSphere> spheres_;  // That stand for the robot,
  std::map<int, Json> bodies_;           // or its own bodies (ShownBodies::shapes).
  std::vector<int> moving_;
  std::vector<std::string> notes_;  // What is not shown, or not as it is.
  Json json_;
};

/// The view of a request, without goals and paths.
View ViewOfRequest(const ShownRobot& shown, const ShownScene& scene, const RunRecordMessage& run) {
  const Robot& robot = shown.robot();
  const PlanRequest& request = run.request;
  if (!request.robot_id.empty() && request.robot_id != robot.content_id) {
    throw InputError(
        fmt::format("{} is not the robot of run {}, whose content is {}: give it with --robot DIR",
                    robot.folder.string(), run.request_id, request.robot_id));
  }
  return {shown, scene, request.group, request.start, request.goal, request.collision_model};
}

std::string TitleOf(const RunRecordMessage& run) {
  return run.problem_set.empty() ? "Request " + run.request_id
                                 : fmt::format("{} {}", run.problem_set, run.problem_index);
}

/// Who tries, in which direction and for which time, as far as it is known.
std::string AttemptOf(const RunRecordMessage& run) {
  std::string text = run.contestant.empty() ? "" : run.contestant + ", ";
  text += EnumName(run.request.direction);
  if (!run.problem_set.empty()) text += fmt::format(", trial {}", run.trial);
  return text;
}

}  // namespace

Json ProblemView(const ShownRobot& shown, const Problem& problem, CollisionModel model) {
  const Robot& robot = shown.robot();
  View view(shown, problem.scene, problem.group, problem.start, problem.goal, model);
  view.AddGoals({}, {});
  return view.Take(
      fmt::format("{} {}", problem.set, problem.index),
      {fmt::format("Robot {}, group {}.", robot.name, robot.Group(problem.group).name)});
}

Json RunView(const ShownRobot& shown, const ShownScene& scene, const RunRecordMessage& run,
             int num_frames) {
  View view = ViewOfRequest(shown, scene, run);
  const PlanResult& result = run.result.result;
  const std::vector<std::string>& joint_names = run.result.joint_names;
  const std::string why_not = result.path.empty() ? "" : view.WhyNotShown(joint_names);
  view.AddGoals(why_not.empty() ? result.path : Path(), joint_names);
  if (why_not.empty()) {
    view.AddMotion("raw", result.path, joint_names, run.path_check, num_frames);
    view.AddMotion("simplified", result.simplified_path, joint_names, run.simplified_check,
                   num_frames);
  }
  std::vector<std::string> facts = {fmt::format("{}: {}{}{}.", AttemptOf(run), EnumName(run.status),
                                                run.message.empty() ? "" : ": ", run.message)};
  if (run.status != PlanStatus::kNoAnswer) {
    facts.push_back(
        fmt::format("Planning time {} ms.", FormatNumber(1e3 * result.planning_time_s)));
  }
  if (!why_not.empty()) facts.push_back(fmt::format("Its path is not shown: {}.", why_not));
  return view.Take(TitleOf(run), std::move(facts));
}

Json RequestView(const ShownRobot& shown, const ShownScene& scene, const RunRecordMessage& run) {
  View view = ViewOfRequest(shown, scene, run);
  view.AddGoals({}, {});
  return view.Take(TitleOf(run), {fmt::format("{}: {}.", AttemptOf(run), run.message)});
}

}  // namespace planbench
