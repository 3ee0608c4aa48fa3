#include "planner_ara/ara_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <optional>

#include "common/error.h"
#include "planning/experience.h"
#include "planning/told_edges.h"

namespace planbench {
namespace {

// Words for infinity.
constexpr std::string_view kEverywhere = "everywhere";
constexpr std::string_view kNever = "never";

// What enters costs, guides and bounds: sums of squares of it, and products of several, are numbers
// still, and none is lost beside another.
constexpr double kLeastFactor = 1e-6;
constexpr double kMostFactor = 1e6;

double ReadPositive(const YamlNode& node) { return node.PositiveDouble(); }

double ReadFactor(const YamlNode& node) { return node.DoubleWithin(kLeastFactor, kMostFactor); }

void ApplyByJoint(const YamlNode& node, const std::string& key, double (*read)(const YamlNode&),
                  std::map<std::string, double>* values) {
  const std::optional<YamlNode> map = node.Find(key);
  if (!map) return;
  for (const std::string& joint : map->Keys()) (*values)[joint] = read(map->At(joint));
}

double NonNegative(const YamlNode& node, const std::string& key, double fallback) {
  const std::optional<YamlNode> value = node.Find(key);
  return value ? value->NonNegativeDouble() : fallback;
}

double Factor(const YamlNode& node, const std::string& key, double fallback) {
  const std::optional<YamlNode> value = node.Find(key);
  return value ? ReadFactor(*value) : fallback;
}

double FactorOrZero(const YamlNode& node, const std::string& key, double fallback) {
  return NonNegative(node, key, fallback) == 0 ? 0 : Factor(node, key, fallback);
}

double Positive(const YamlNode& node, const std::string& key, double fallback) {
  const std::optional<YamlNode> value = node.Find(key);
  return value ? value->PositiveDouble() : fallback;
}

double AtLeastOne(const YamlNode& node, const std::string& key, double fallback) {
  const std::optional<YamlNode> value = node.Find(key);
  return value ? value->DoubleWithin(1, kMostFactor) : fallback;
}

// What `read` reads, or infinity where the word for it stands.
double OrWord(const YamlNode& node, const std::string& key, std::string_view infinity,
              double (*read)(const YamlNode&, const std::string&, double), double fallback) {
  const std::optional<YamlNode> value = node.Find(key);
  const bool is_word = value && value->IsScalar() && value->String() == infinity;
  return is_word ? std::numeric_limits<double>::infinity() : read(node, key, fallback);
}

std::string TextOrWord(double value, std::string_view infinity) {
  return std::isfinite(value) ? fmt::format("{}", value) : std::string(infinity);
}

std::string ByJointAsText(const std::map<std::string, double>& values) {
  std::vector<std::string> texts;
  for (const auto& [joint, value] : values) texts.push_back(fmt::format("{}: {}", joint, value));
  return fmt::format("{{{}}}", fmt::join(texts, ", "));
}

}  // namespace

void AraSettings::Apply(const YamlNode& node) {
  node.AllowOnly({"discretization",
                  "joint_weights",
                  "primitives",
                  "use_long_primitives",
                  "use_short_primitives",
                  "long_primitives_beyond",
                  "short_primitives_within",
                  "two_way",
                  "crowding",
                  "crowding_joints",
                  "bridge_after",
                  "tip_guide",
                  "arm_by_arm",
                  "cost",
                  "evaluation",
                  "burs",
                  "refine",
                  "shorten",
                  "wrap_heuristic",
                  "fit_cells",
                  kEdgeWeights,
                  "experience",
                  "recall",
                  "epsilon_initial",
                  "epsilon_decrement",
                  "epsilon_final",
                  "memory_limit_mb"});
  node.RequireValues();
  ApplyByJoint(node, "discretization", ReadPositive, &discretization);
  ApplyByJoint(node, kEdgeWeights, ReadFactor, &edge_weights);
  fit_cells = node.BoolOr("fit_cells", fit_cells);
  if (const std::optional<YamlNode> value = node.Find("evaluation")) {
    evaluation = value->Enum<Evaluation>();
  }
  burs = node.BoolOr("burs", burs);
  refine = node.BoolOr("refine", refine);
  shorten = node.BoolOr("shorten", shorten);
  wrap_heuristic = node.BoolOr("wrap_heuristic", wrap_heuristic);
  ApplyByJoint(node, "joint_weights", ReadFactor, &joint_weights);
  if (const std::optional<YamlNode> value = node.Find("primitives")) {
    primitives = value->String() == "generated" ? "" : value->String();
  }
  use_long_primitives = node.BoolOr("use_long_primitives", use_long_primitives);
  use_short_primitives = node.BoolOr("use_short_primitives", use_short_primitives);
  long_primitives_beyond = NonNegative(node, "long_primitives_beyond", long_primitives_beyond);
  short_primitives_within =
      OrWord(node, "short_primitives_within", kEverywhere, NonNegative, short_primitives_within);
  two_way = node.BoolOr("two_way", two_way);
  bridge_after = OrWord(node, "bridge_after", kNever, Positive, bridge_after);
  crowding = FactorOrZero(node, "crowding", crowding);
  if (const std::optional<YamlNode> joints = node.Find("crowding_joints")) {
    crowding_joints = joints->Strings();
  }
  tip_guide = FactorOrZero(node, "tip_guide", tip_guide);
  arm_by_arm = node.BoolOr("arm_by_arm", arm_by_arm);
  if (const std::optional<YamlNode> value = node.Find("cost")) cost = value->Enum<MoveCost>();
  if (const std::optional<YamlNode> file = node.Find("experience")) experience = file->String();
  if (const std::optional<YamlNode> value = node.Find("recall")) {
    recall = ReadRecall(*value, experience);
  }
  epsilon.initial = AtLeastOne(node, "epsilon_initial", epsilon.initial);
  epsilon.decrement = Factor(node, "epsilon_decrement", epsilon.decrement);
  epsilon.final = AtLeastOne(node, "epsilon_final", epsilon.final);
  memory_limit_mb = Positive(node, "memory_limit_mb", memory_limit_mb);
}

void AraSettings::Validate(const std::string& origin) const {
  if (epsilon.initial < epsilon.final) {
    throw InputError(fmt::format("{}: epsilon_initial {} is less than epsilon_final {}", origin,
                                 epsilon.initial, epsilon.final));
  }
  if (!experience.empty() && !wrap_heuristic) {
    throw InputError(origin + ": experience needs wrap_heuristic");
  }
}

std::string AraSettings::VariantName() const {
  std::vector<std::string> variants;
  if (two_way) variants.emplace_back("two-way");
  if (tip_guide > 0 || crowding > 0) variants.emplace_back("guided");
  if (burs) variants.emplace_back("burs");
  if (!experience.empty()) variants.emplace_back("experience");
  if (variants.empty()) return "ARA*";
  return fmt::format("ARA* ({})", fmt::join(variants, ", "));
}

std::map<std::string, std::string> AraSettings::AsText() const {
  std::map<std::string, std::string> text{
      {"discretization", ByJointAsText(discretization)},
      {"joint_weights", ByJointAsText(joint_weights)},
      {"primitives", primitives.empty() ? "generated" : primitives.string()},
      {"use_long_primitives", fmt::format("{}", use_long_primitives)},
      {"use_short_primitives", fmt::format("{}", use_short_primitives)},
      {"long_primitives_beyond", fmt::format("{}", long_primitives_beyond)},
      {"short_primitives_within", TextOrWord(short_primitives_within, kEverywhere)},
      {"two_way", fmt::format("{}", two_way)},
      {"bridge_after", TextOrWord(bridge_after, kNever)},
      {"crowding", fmt::format("{}", crowding)},
      {"tip_guide", fmt::format("{}", tip_guide)},
      {"arm_by_arm", fmt::format("{}", arm_by_arm)},
      {"cost", std::string(EnumName(cost))},
      {"evaluation", std::string(EnumName(evaluation))},
      {"burs", fmt::format("{}", burs)},
      {"refine", fmt::format("{}", refine)},
      {"shorten", fmt::format("{}", shorten)},
      {"wrap_heuristic", fmt::format("{}", wrap_heuristic)},
      {"fit_cells", fmt::format("{}", fit_cells)},
      {"epsilon_initial", fmt::format("{}", epsilon.initial)},
      {"epsilon_decrement", fmt::format("{}", epsilon.decrement)},
      {"epsilon_final", fmt::format("{}", epsilon.final)},
      {"memory_limit_mb", fmt::format("{}", memory_limit_mb)},
  };
  if (!crowding_joints.empty()) {
    text["crowding_joints"] = fmt::format("[{}]", fmt::join(crowding_joints, ", "));
  }
  if (!experience.empty()) {
    text["experience"] = experience;
    text["recall"] = fmt::format("{}", recall);
  }
  if (!edge_weights.empty()) text[kEdgeWeights] = ByJointAsText(edge_weights);
  return text;
}

}  // namespace planbench
