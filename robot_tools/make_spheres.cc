#include "robot_tools/make_spheres.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <memory>
#include <system_error>
#include <utility>

#include "common/command_line.h"
#include "common/error.h"
#include "common/name_value.h"
#include "common/progress_line.h"
#include "common/read_text.h"
#include "common/stopwatch.h"
#include "common/write_file.h"
#include "robot_tools/link_bodies.h"
#include "robot_tools/sphere_writer.h"
#include "sphere_fitting/inner_spheres.h"
#include "sphere_fitting/outer_spheres.h"
#include "sphere_fitting/tightness.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;
using Sets = std::vector<std::vector<Ball>>;

struct Row {
  std::string name;
  Tightness outer;
  Tightness inner;
  double seconds = 0;
};

std::string Ratio(const Tightness& tightness) {
  const auto ratio = tightness.volume_ratio();
  return ratio ? fmt::format("{:.2f}", *ratio) : "-";
}

std::vector<std::string> Table(const std::vector<Row>& rows, bool with_inner) {
  std::size_t width = 4;
  for (const Row& row : rows) width = std::max(width, row.name.size());
  std::vector<std::string> lines;
  lines.push_back(fmt::format("{:<{}}  {:>7}  {:>12}  {:>8}  {:>6}{}  {:>6}", "link", width,
                              "spheres", "greatest, mm", "mean, mm", "volume",
                              with_inner ? "   inner  volume" : "", "time, s"));
  for (const Row& row : rows) {
    lines.push_back(fmt::format(
        "{:<{}}  {:>7}  {:>12.1f}  {:>8.1f}  {:>6}{}  {:>7.1f}", row.name, width, row.outer.balls,
        1000 * row.outer.greatest_m, 1000 * row.outer.mean_m(), Ratio(row.outer),
        with_inner ? fmt::format("  {:>6}  {:>6}", row.inner.balls, Ratio(row.inner)) : "",
        row.seconds));
  }
  return lines;
}

// By index in `links`.
std::map<std::size_t, double> ProtrusionOfLinks(const std::vector<std::string>& flags,
                                                const RobotModel& model, const LinkBodies& links) {
  std::map<std::size_t, double> protrusion_m;
  for (const std::string& flag : flags) {
    const auto [name, value] = SplitNameValue(flag, "--link", "NAME=M");
    const auto found = std::find(links.links.begin(), links.links.end(), model.FindLink(name));
    if (found == links.links.end()) {
      throw InputError(fmt::format("--link {}: no link '{}' with collision geometry", flag, name));
    }
    double metres = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), metres);
    if (error != std::errc() || end != value.data() + value.size() || !(metres > 0)) {
      throw InputError(fmt::format("--link {}: '{}' is no length, m", flag, value));
    }
    protrusion_m[static_cast<std::size_t>(found - links.links.begin())] = metres;
  }
  return protrusion_m;
}

}  // namespace

void MakeSpheresFlags::AddTo(CLI::App* app) {
  app->add_option("--urdf", urdf, "the robot's URDF, expanded from xacro")->required();
  app->add_option("--package-path", package_paths, "NAME=DIR, for package:// URIs of meshes");
  auto* goal = app->add_option_group("goal", "one of:");
  goal->add_option("--spheres", spheres, "so many on all links together, as close as they can be")
      ->check(CLI::Range(1, 100'000));
  CLI::Option* protrusion =
      goal->add_option("--protrusion", protrusion_m,
                       "as many as it takes so that none reaches further beyond its link, m")
          ->check(Positive());
  goal->require_option(1);
  app->add_option("--link", links,
                  "NAME=M: with --protrusion: how far spheres of link NAME may reach; repeatable")
      ->needs(protrusion)
      ->allow_extra_args(false);
  app->add_option("--most-a-link", most_a_link,
                  "with --protrusion: no more on any link, however far they reach")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  app->add_option("--outer", outer, "write the spheres that enclose the links, a spheres.yaml");
  app->add_option("--inner", inner, "write spheres that are inside the links, a spheres.yaml");
  app->add_option("--srdf", srdf,
                  "write the enclosing spheres as an SRDF's link_sphere_approximation");
  app->add_option("--urdf-out", urdf_out,
                  "write the URDF with the enclosing spheres as its collision geometry");
}

void MakeSpheres(const MakeSpheresFlags& flags, const SayLine& say) {
  const std::string urdf_text = ReadText(flags.urdf);
  std::vector<std::string> warnings;
  const RobotModel model = RobotModel::FromUrdf(urdf_text, flags.urdf.string(), &warnings);
  for (const std::string& warning : warnings) say(warning);
  const ResourceResolver resources{fs::absolute(flags.urdf).parent_path(),
                                   ParsePackagePaths(flags.package_paths)};
  const LinkBodies links = ReadLinkBodies(model, resources, say);
  if (links.links.empty()) {
    throw InputError(flags.urdf.string() + ": no link has collision geometry");
  }

  FitGoal goal;
  if (flags.spheres > 0) goal.spheres = flags.spheres;
  if (flags.protrusion_m > 0) goal.protrusion_m = flags.protrusion_m;
  goal.protrusion_of_m = ProtrusionOfLinks(flags.links, model, links);
  goal.most_a_link = flags.most_a_link;
  std::vector<OuterSet> fitted;
  {
    ProgressLine progress(goal.spheres.value_or(0) + static_cast<int>(links.links.size()), 0,
                          /*pieces_are_alike=*/false);
    fitted = FitOuterSpheres(links.bodies, goal,
                             [&](int done, const std::string& text) { progress.Show(done, text); });
  }
  const bool with_inner = !flags.inner.empty();
  Sets outer;
  Sets inner;
  std::vector<Row> rows;
  Row all{"all", {}, {}, 0};
  for (std::size_t i = 0; i < links.links.size(); ++i) {
    const LinkBody& body = links.bodies[i];
    Row row{model.links()[static_cast<std::size_t>(links.links[i])].name, {}, {}, 0};
    outer.push_back(fitted[i].balls);
    row.outer = MeasureTightness(body, outer.back());
    row.seconds = fitted[i].seconds;
    if (with_inner) {
      const Stopwatch clock;
      inner.push_back(FitInnerSpheres(body, row.outer.balls));
      row.seconds += clock.seconds();
      row.inner = MeasureTightness(body, inner.back());
    }
    all.outer.Add(row.outer);
    all.inner.Add(row.inner);
    all.seconds += row.seconds;
    rows.push_back(std::move(row));
  }
  rows.push_back(all);
  for (const std::string& line : Table(rows, with_inner)) say(line);

  const std::vector<LinkSphere> spheres = ToLinkSpheres(links, outer);
  const std::string origin = flags.urdf.filename().string();
  if (!flags.outer.empty()) {
    WriteFile(
        flags.outer,
        SpheresYaml(
            model, spheres,
            {fmt::format("Made by make_spheres from {}: proven to enclose its", origin),
             fmt::format("collision geometry. {} spheres; they reach up to {:.1f} mm "
                         "beyond it, {:.1f} mm",
                         spheres.size(), 1000 * all.outer.greatest_m, 1000 * all.outer.mean_m()),
             "in the mean over their surface."}));
  }
  if (with_inner) {
    WriteFile(
        flags.inner,
        SpheresYaml(model, ToLinkSpheres(links, inner),
                    {fmt::format("Made by make_spheres from {}: proven to be inside its", origin),
                     "collision geometry."}));
  }
  if (!flags.srdf.empty()) WriteFile(flags.srdf, SpheresSrdf(model, spheres));
  if (!flags.urdf_out.empty()) WriteFile(flags.urdf_out, SpheresUrdf(urdf_text, model, spheres));
}

}  // namespace planbench
