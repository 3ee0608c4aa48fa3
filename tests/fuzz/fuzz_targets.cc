#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

#include "benchmark_driver/line_up.h"
#include "common/error.h"
#include "geometry/octomap.h"
#include "messaging/codec.h"
#include "messaging/event_log.h"
#include "messaging/event_log_reader.h"
#include "messaging/packet_reader.h"
#include "planner_ara/ara_settings.h"
#include "planner_ara/motion_primitives.h"
#include "planner_rrtc/rrtc_settings.h"
#include "results/imported_results.h"
#include "results/stored_session.h"
#include "robot_model/robot_folder.h"
#include "robot_model/srdf.h"
#include "scene/moveit_yaml.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/messaging/message_examples.h"
#include "tests/scene/problem_texts.h"
#include "tests/support/session_database.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;
using Input = std::span<const std::uint8_t>;

const fs::path kSource = PLANBENCH_SOURCE_DIR;

const TemporaryFolder& Scratch() {
  static const TemporaryFolder folder;
  return folder;
}

Bytes BytesOf(std::string_view text) { return {text.begin(), text.end()}; }
std::string TextOf(Input input) {
  return {reinterpret_cast<const char*>(input.data()), input.size()};
}

Bytes ReadFile(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  return BytesOf(std::string(std::istreambuf_iterator<char>(file), {}));
}

fs::path Written(const std::string& name, Input input) {
  fs::remove(Scratch() / name);  // Overwriting would wait for the disk.
  return Scratch().Write(name, TextOf(input));
}

// Two texts in one input, apart by a line of dashes.
constexpr std::string_view kDivision = "\n--------\n";
std::pair<std::string, std::string> Divided(Input input) {
  const std::string text = TextOf(input);
  const std::size_t at = text.find(kDivision);
  if (at == std::string::npos) return {text, ""};
  return {text.substr(0, at), text.substr(at + kDivision.size())};
}
Bytes Joined(const Bytes& first, const Bytes& second) {
  return BytesOf(TextOf(first) + std::string(kDivision) + TextOf(second));
}

template <typename... Messages>
FuzzTarget MessagesTarget() {
  FuzzTarget target;
  target.name = "messages";
  target.num_inputs = 4000;
  // The first byte says as which.
  target.seeds = {[] {
    Bytes bytes = Encode(Example<Messages>());
    bytes.insert(bytes.begin(), 0);
    return bytes;
  }()...};
  for (std::size_t i = 0; i < target.seeds.size(); ++i) {
    target.seeds[i][0] = static_cast<std::uint8_t>(i);
  }
  target.read = [](Input input) {
    if (input.empty()) return;
    using Reader = void (*)(Input);
    static constexpr std::array<Reader, sizeof...(Messages)> kReaders = {[](Input bytes) {
      const auto message = Decode<Messages>(bytes, "CHANNEL");
      Encode(message);
      Print<Messages>(bytes, "CHANNEL");
    }...};
    kReaders[input[0] % kReaders.size()](input.subspan(1));
  };
  return target;
}

FuzzTarget PacketsTarget() {
  FuzzTarget target{"packets", nullptr, {}, 4000};
  // Packets one after the other, each behind its sender and its length (a byte, 16 bits).
  const auto append = [](Bytes* input, std::uint8_t sender, const Bytes& packet) {
    input->push_back(sender);
    input->push_back(static_cast<std::uint8_t>(packet.size() >> 8));
    input->push_back(static_cast<std::uint8_t>(packet.size()));
    input->insert(input->end(), packet.begin(), packet.end());
  };
  const auto number = [](Bytes* packet, std::uint64_t value, int num_bytes) {
    for (int i = num_bytes - 1; i >= 0; --i) {
      packet->push_back(static_cast<std::uint8_t>(value >> 8 * i));
    }
  };
  Bytes small = BytesOf("LC02");
  number(&small, 1, 4);
  for (const char c : std::string("CHANNEL")) small.push_back(static_cast<std::uint8_t>(c));
  small.insert(small.end(), {0, 1, 2, 3});
  Bytes seed;
  append(&seed, 1, small);
  append(&seed, 2, small);
  for (int i = 0; i < 3; ++i) {
    Bytes fragment = BytesOf("LC03");
    number(&fragment, 2, 4);
    number(&fragment, 30, 4);  // bytes of the message
    number(&fragment, 10u * static_cast<unsigned>(i), 4);
    number(&fragment, static_cast<unsigned>(i), 2);
    number(&fragment, 3, 2);  // fragments
    if (i == 0) {
      for (const char c : std::string("LONG")) fragment.push_back(static_cast<std::uint8_t>(c));
      fragment.push_back(0);
    }
    fragment.insert(fragment.end(), 10, static_cast<std::uint8_t>(i));
    append(&seed, 1, fragment);
  }
  target.seeds = {seed};
  target.read = [](Input input) {
    PacketReader reader(1 << 20);
    while (input.size() >= 3) {
      const PacketSender sender{input[0], 1};
      const std::size_t size = std::min<std::size_t>(input[1] * 256u + input[2], input.size() - 3);
      const auto message = reader.Read(sender, input.subspan(3, size), 0);
      if (message && message->bytes.size() > PacketReader::kMaxMessageBytes) std::abort();
      input = input.subspan(3 + size);
    }
  };
  return target;
}

FuzzTarget EventLogTarget() {
  const fs::path file = Scratch() / "seed.lcmlog";
  {
    EventLog log(file, EventLog::Mode::kNew);
    for (const char* channel : {"DISCOVER", "A"}) log.Write({channel, {1, 2, 3, 4}, 1000});
  }
  return {"event_log",
          [](Input input) {
            ReadEventLog(Written("fuzz.lcmlog", input), [](const ReceivedMessage&) {});
          },
          {ReadFile(file)},
          1000};
}

FuzzTarget DatabaseTarget() {
  WriteSession(Scratch() / "session", {{.contestant = "a"}, {.contestant = "b"}});
  return {"database",
          [](Input input) { ReadSessions(Written("fuzz.sqlite", input)); },
          {ReadFile(Scratch() / "session/results.sqlite")},
          60};
}

FuzzTarget ProblemTarget() {
  static const Robot robot = TextRobot();
  const std::string poses = R"(group_name: arm
goal_constraints:
  - position_constraints:
      - link_name: gripper_link
        constraint_region:
          primitives: [{type: 2, dimensions: [0.001]}]
          primitive_poses: [{position: [0, 1, 3], orientation: [0, 0, 0, 1]}]
    orientation_constraints:
      - {link_name: gripper_link, orientation: [0, 0, 0.6, 0.8], absolute_z_axis_tolerance: 0.1}
)";
  const std::string octomap = R"(robot_model_name: fetch
robot_state: {multi_dof_joint_state: {joint_names: [], transforms: []}}
world:
  octomap:
    header: {frame_id: base_link}
    origin: {position: [0, 2, 0], orientation: [0, 0, 0, 1]}
    octomap: {binary: true, id: OcTree, resolution: 0.1, data: [0, -128]}
)";
  return {"problem",
          [](Input input) {
            const auto [scene, request] = Divided(input);
            ParseProblem(YamlNode::Parse(scene, "scene.yaml"),
                         YamlNode::Parse(request, "request.yaml"), robot, {});
          },
          {Joined(BytesOf(kFullScene), BytesOf(kFullRequest)),
           Joined(BytesOf(octomap), BytesOf(poses))},
          250};
}

FuzzTarget RobotFolderTarget() {
  for (const char* name : {"planar3.urdf", "spheres.yaml"}) {
    Scratch().Write(std::string("robot/") + name,
                    TextOf(ReadFile(kSource / "tests/data/planar3" / name)));
  }
  return {"robot_folder",
          [](Input input) {
            Written("robot/robot.yaml", input);
            LoadRobot(Scratch() / "robot");
          },
          {BytesOf(R"(name: planar3
urdf: planar3.urdf
spheres: spheres.yaml
enclosing_spheres: spheres.yaml
edge_resolution_m: 0.02
edge_check: certified
groups:
  - name: arm
    joints: [shoulder, elbow, wrist]
    tip_link: tip
    states: {bent: [0, 1.5, -1.5]}
allowed_pairs:
  - [column, forearm]
links_without_spheres: [base]
planners: {rrtc: rrtc.yaml}
voxels: {resolution_m: 0.02, lower: [-1, -1, 0], upper: [1, 1, 2], walls: true, hollow: true}
)")},
          250};
}

FuzzTarget UrdfTarget() {
  return {
      "urdf",
      [](Input input) {
        std::vector<std::string> warnings;
        RobotModel::FromUrdf(TextOf(input), "robot.urdf", &warnings);
      },
      {ReadFile(kSource / "tests/data/planar3/planar3.urdf"),
       ReadFile(kSource / "robots/ur5e/ur5e.urdf"), ReadFile(kSource / "robots/panda/panda.urdf")},
      400};
}

FuzzTarget SrdfTarget() {
  static const RobotModel panda =
      RobotModel::FromUrdf(TextOf(ReadFile(kSource / "robots/panda/panda.urdf")), "panda.urdf");
  return {"srdf",
          [](Input input) { ParseSrdf(TextOf(input), "robot.srdf", panda); },
          {BytesOf(R"(<?xml version="1.0"?><robot name="panda">
  <group name="arm"><chain base_link="panda_link0" tip_link="panda_hand"/></group>
  <group name="hand"><joint name="panda_finger_joint1"/><link name="panda_hand"/></group>
  <group name="all"><group name="arm"/><group name="hand"/></group>
  <group_state name="ready" group="arm"><joint name="panda_joint4" value="-2.3"/></group_state>
  <end_effector name="eef" parent_link="panda_link7" group="hand" parent_group="arm"/>
  <virtual_joint name="v" type="floating" parent_frame="world" child_link="panda_link0"/>
  <disable_collisions link1="panda_link1" link2="panda_link2" reason="Adjacent"/>
  <enable_collisions link1="panda_link2" link2="panda_link3"/>
  <link_sphere_approximation link="panda_link1"><sphere center="0 0 0.1" radius="0.1"/>
  </link_sphere_approximation></robot>)")},
          1000};
}

const JointSpace& TwoJoints() {
  static const JointSpace space(
      {{"lift", false, true, 0, 0.4, 1}, {"roll", true, false, -3.2, 3.2, 1}});
  return space;
}

FuzzTarget MprimTarget() {
  return {"mprim",
          [](Input input) { ParseMotionPrimitives(TextOf(input), "arm.mprim", 2); },
          {BytesOf("Motion_Primitives(degrees): 3 2 1\n15 0\n0 -15\n8 8\n")},
          4000};
}

FuzzTarget MovesTarget() {
  return {"moves",
          [](Input input) {
            ReadMotionPrimitives(YamlNode::Parse(TextOf(input), "arm.yaml"), TwoJoints(),
                                 std::vector<double>{0.005, 0.0174532925199433});
          },
          {BytesOf("angle_unit: deg\nlength_unit: m\nlong:\n  - {roll: 20, lift: -0.1}\n"
                   "  - {roll: 20}\nshort:\n  - {lift: 0.05}\n")},
          2000};
}

FuzzTarget SettingsTarget() {
  return {"settings",
          [](Input input) {
            const auto [ara, rrtc] = Divided(input);
            std::optional<InputError> error;  // Of the first; both are read.
            try {
              AraSettings settings;
              settings.Apply(YamlNode::Parse(ara, "ara.yaml"));
              settings.Validate("ara.yaml");
              settings.AsText();
            } catch (const InputError& failure) {
              error = failure;
            }
            DescribeSettings(ReadRrtcSettings(YamlNode::Parse(rrtc, "rrtc.yaml"), {}));
            if (error) throw *error;
          },
          {Joined(ReadFile(kSource / "robots/fetch/ara_study.yaml"),
                  ReadFile(kSource / "robots/fetch/rrtc_study.yaml")),
           Joined(BytesOf("crowding: 0.1\ncrowding_joints: [lift]\njoint_weights: {lift: 2}\n"),
                  BytesOf("algorithm: BKPIECE1\nrange: 0.5\nompl: {goal_bias: 0.1}\n"))},
          1000};
}

FuzzTarget LineUpTarget() {
  return {
      "line_up",
      [](Input input) { ReadLineUp(Written("line_up.yaml", input), kSource / "robots/fetch"); },
      {ReadFile(kSource / "lineups/default.yaml"), ReadFile(kSource / "lineups/study.yaml"),
       BytesOf("contestants:\n  a: {program: rrtc, set: {range: 0.5}, sweep: {range: [1, 2]}}\n")},
      500};
}

FuzzTarget ImportTarget() {
  return {
      "import",
      [](Input input) {
        std::vector<std::string> warnings;
        ImportResults(Written("import", input), "paper", 10, &warnings);
      },
      {BytesOf("problem_set,problem_index,solved,time_s,direction,trial,time_limit_s\n"
               "shelf,1,1,0.5,forward,1,10\nshelf,2,0,10,backward,2,10\n"),
       BytesOf("OMPL version 1.6.0\nExperiment lab/3\nRunning on host1\nStarting at 2024-05-01 "
               "10:00:00\n<<<|\nsetup\n|>>>\n7 is the random seed\n2.5 seconds per run\n0 MB per "
               "run\n1 runs per planner\n1.5 seconds spent to collect the data\n0 enum "
               "types\n1 planners\ngeometric_RRT\n0 common properties\n2 properties for each "
               "run\nsolved BOOLEAN\ntime REAL\n1 runs\n1; 0.5; \n.\n")},
      2000};
}

FuzzTarget OctomapTarget() {
  // A node with children of each kind, twice over; the first byte chooses the form.
  Bytes seed = {1};
  for (int i = 0; i < 40; ++i) seed.push_back(static_cast<std::uint8_t>(0x1b + 37 * i));
  return {"octomap",
          [](Input input) {
            if (input.empty()) return;
            OctomapBoxes(input.subspan(1), (input[0] & 1) != 0, "OcTree", 0.05);
          },
          {seed, {0, 0x3f, 0x80, 0, 0, 0x01, 0, 0, 0, 0, 0}, {1, 0xff, 0xff, 0, 0}},
          4000};
}

void AddCorpus(FuzzTarget* target) {
  const fs::path folder = kSource / "tests/fuzz/corpus" / target->name;
  if (!fs::exists(folder)) return;
  for (const auto& entry : fs::directory_iterator(folder)) {
    target->seeds.push_back(ReadFile(entry.path()));
  }
}

}  // namespace

const std::vector<FuzzTarget>& FuzzTargets() {
  static const std::vector<FuzzTarget> targets = [] {
    static const std::string store = (Scratch() / "meshes").string();
    setenv("PLANBENCH_MESH_STORE", store.c_str(), 1);
    std::vector<FuzzTarget> all = {
        MessagesTarget<DiscoverMessage, NodeStatusMessage, ProblemSetsMessage,
                       ProblemRequestMessage, ProblemMessage, SceneRequestMessage, SceneMessage,
                       PlanRequest, PlanAckMessage, PlanProgressMessage, PlanResultMessage,
                       PlanCancelMessage, AckMessage, CollisionRequestMessage,
                       CollisionReplyMessage, PathCheckRequestMessage, PathCheckReplyMessage,
                       SessionMessage, RunRecordMessage>(),
        PacketsTarget(),
        EventLogTarget(),
        DatabaseTarget(),
        ProblemTarget(),
        RobotFolderTarget(),
        UrdfTarget(),
        SrdfTarget(),
        MprimTarget(),
        MovesTarget(),
        SettingsTarget(),
        LineUpTarget(),
        ImportTarget(),
        OctomapTarget()};
    for (FuzzTarget& target : all) AddCorpus(&target);
    return all;
  }();
  return targets;
}

}  // namespace planbench
