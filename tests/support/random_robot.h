#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <random>
#include <string>
#include <vector>

#include "common/random.h"
#include "robot_model/robot_folder.h"

namespace planbench {

/// A robot drawn at random: a chain of `num_joints` joints, revolute, continuous and prismatic ones
/// mixed, about axes of any direction, with two spheres a link. The base is held by a floating
/// joint, in the middle of the chain stands a post that is welded on and carries a flag that
/// follows a joint of the chain (or is held), at the end are a slide that is held and a tool that
/// is welded to it. The group "chain" has all joints of the chain. Equal seeds give equal robots.
inline Robot MakeRandomRobot(int num_joints, std::uint64_t seed, bool with_follower = true) {
  std::mt19937_64 random(seed * 100 + static_cast<std::uint64_t>(num_joints));
  const auto between = [&](double lower, double upper) {
    return lower + UniformFraction(&random) * (upper - lower);
  };
  std::string links = "<link name='world'/><link name='base'/>";
  std::string joints =
      "<joint name='place' type='floating'><parent link='world'/><child link='base'/></joint>";
  std::vector<std::string> names;
  std::vector<std::pair<std::string, std::vector<double>>> balls = {{"base", {-0.1, 0.1}}};
  std::string leader;  // Of the flag: the first joint with limits.
  std::string parent = "base";
  double length = 0.1;  // Of the parent.
  for (int j = 0; j < num_joints; ++j) {
    const std::string link = fmt::format("link{}", j);
    names.push_back(fmt::format("joint{}", j));
    // The first three have one of each type.
    const auto kind = j < 3 ? static_cast<std::uint64_t>(j) : random() % 4;
    const std::string type = kind == 1 ? "continuous" : kind == 2 ? "prismatic" : "revolute";
    std::string axis;
    if (random() % 3 == 0) {
      axis = fmt::format("{} {} {}", between(0.2, 1), between(-1, 1), between(-1, 1));
    } else {
      axis = std::array{"1 0 0", "0 1 0", "0 0 1"}[random() % 3];
    }
    const std::string limit =
        type == "prismatic"
            ? fmt::format("lower='{}' upper='{}'", between(-0.2, 0), between(0.1, 0.3))
            : fmt::format("lower='{}' upper='{}'", between(-3, -1), between(1, 3));
    joints += fmt::format(
        "<joint name='{}' type='{}'><parent link='{}'/><child link='{}'/>"
        "<origin xyz='{} 0 0' rpy='{} {} {}'/><axis xyz='{}'/>{}</joint>",
        names.back(), type, parent, link, length, between(-1, 1), between(-0.5, 0.5),
        between(-0.5, 0.5), axis,
        type == "continuous" ? "" : fmt::format("<limit {} velocity='1' effort='1'/>", limit));
    if (leader.empty() && type == "revolute") leader = names.back();
    links += fmt::format("<link name='{}'/>", link);
    length = between(0.15, 0.3);
    balls.push_back({link, {0.35 * length, 0.75 * length}});
    if (j == num_joints / 2) {
      links += "<link name='post'/><link name='flag'/>";
      joints += fmt::format(
          "<joint name='weld' type='fixed'><parent link='{}'/><child link='post'/>"
          "<origin xyz='{} 0 0.1'/></joint>"
          "<joint name='hoist' type='prismatic'><parent link='post'/><child link='flag'/>"
          "<axis xyz='0 0 1'/><limit lower='-1' upper='1' velocity='1' effort='1'/>"
          "{}</joint>",
          link, length / 2,
          with_follower
              ? fmt::format("<mimic joint='{}' multiplier='-0.02' offset='0.06'/>", leader)
              : "");
      balls.push_back({"post", {0}});
      balls.push_back({"flag", {0}});
    }
    parent = link;
  }
  links += "<link name='jaw'/><link name='tool'/>";
  joints += fmt::format(
      "<joint name='slide' type='prismatic'><parent link='{}'/><child link='jaw'/>"
      "<origin xyz='{} 0 0'/><limit lower='0.02' upper='0.1' velocity='1' effort='1'/></joint>"
      "<joint name='grip' type='fixed'><parent link='jaw'/><child link='tool'/>"
      "<origin xyz='0.05 0 0'/></joint>",
      parent, length);
  balls.push_back({"tool", {0, 0.05}});

  Robot robot;
  robot.name = fmt::format("random{}", num_joints);
  robot.content_id = robot.name;
  robot.model = RobotModel::FromUrdf(
      fmt::format("<robot name='{}'>{}{}</robot>", robot.name, links, joints), robot.name);
  robot.groups = {robot.model.MakeGroup("chain", names, "tool")};
  for (const auto& [link, xs] : balls) {
    for (const double x : xs) {
      robot.spheres.push_back({robot.model.FindLink(link), {x, 0, 0}, between(0.03, 0.05)});
    }
  }
  std::stable_sort(robot.spheres.begin(), robot.spheres.end(),
                   [](const LinkSphere& a, const LinkSphere& b) { return a.link < b.link; });
  // What carries the post and the flag overlaps them.
  const auto allow = [&](const std::string& a, const std::string& b) {
    robot.allowed_pairs.emplace_back(robot.model.FindLink(a), robot.model.FindLink(b));
  };
  allow(fmt::format("link{}", num_joints / 2), "flag");
  allow("tool", parent);
  return robot;
}

}  // namespace planbench
