#include "scene_server/problem_library.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "common/content_hash.h"
#include "common/error.h"
#include "common/file_kind.h"
#include "common/read_text.h"
#include "messaging/channels.h"
#include "messaging/codec.h"
#include "messaging/packet_reader.h"
#include "robot_model/full_positions.h"
#include "robot_model/referee_misfits.h"
#include "scene/moveit_object_reader.h"
#include "scene/moveit_yaml.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

/// Folders that are named like a problem's files are not what makes a folder a set.
bool HoldsProblems(const fs::path& folder) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (!IsFolder(entry.path()) && ProblemIndexOf(entry.path())) return true;
  }
  return false;
}

/// Editors' locks are such, in Emacs links to nowhere.
bool IsHidden(const fs::path& path) { return path.filename().string().starts_with('.'); }

/// Adds the folder itself if it holds problems, else the folders below it that do. `above`: the
/// folders it is in, real paths, for links that lead back to one. Of a link that cannot be
/// followed nobody knows whether it was to lead to a set: it is refused.
void FindSetFolders(const fs::path& folder, std::vector<fs::path>* above,
                    std::vector<fs::path>* found) {
  if (HoldsProblems(folder)) {
    found->push_back(folder);
    return;
  }
  const fs::path real = fs::canonical(folder);
  if (std::find(above->begin(), above->end(), real) != above->end()) return;
  above->push_back(real);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (!IsHidden(entry.path())) RefuseUnreachable(entry.path());
    if (IsFolder(entry.path())) FindSetFolders(entry.path(), above, found);
  }
  above->pop_back();
}

/// The folder itself if it holds problems, else the folders below it that do, by path.
std::vector<fs::path> SetFolders(const fs::path& folder) {
  RequireProblemFolder(folder);
  std::vector<fs::path> above;
  std::vector<fs::path> found;
  FindSetFolders(folder, &above, &found);
  if (found.empty()) {
    throw InputError(folder.string() +
                     ": holds no problems (pairs of sceneNNNN.yaml and requestNNNN.yaml, or .yml), "
                     "nor does any folder below it");
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// In the place of the id of what could not be read.
constexpr char kUnreadable[] = "";

/// What a problem's scene is made of beside its two files, in words.
std::string NamedBy(const ProblemFiles& files) {
  return fmt::format("a file that {} or its request names", files.scene.string());
}

/// The first warning, and how many there are; "" without one.
std::string Summary(const std::vector<std::string>& warnings) {
  if (warnings.empty()) return "";
  if (warnings.size() == 1) return warnings.front();
  return fmt::format("{} (and {} more)", warnings.front(), warnings.size() - 1);
}

double Megabytes(std::size_t bytes) { return static_cast<double>(bytes) / 1e6; }

/// With spheres for meshes, which go into a store on disk when they are sent.
Scene WithoutMeshes(Scene scene) {
  const auto replace = [](SceneObject* object) {
    for (PlacedShape& placed : object->shapes) {
      if (std::holds_alternative<Mesh>(placed.shape)) placed.shape = Sphere{1};
    }
  };
  for (SceneObject& object : scene.objects) replace(&object);
  for (AttachedObject& attached : scene.attached) replace(&attached.object);
  return scene;
}

/// Throws InputError for what others would not take off the bus: they would wait for it in vain.
/// Returns its size, bytes.
template <typename Message>
std::size_t RequireDeliverable(Message message, const std::string& channel, const fs::path& file) {
  message.request_id = file.filename().string();
  try {
    const std::vector<std::uint8_t> bytes = Encode(message);
    if (bytes.size() > PacketReader::kMaxMessageBytes) {
      throw InputError(fmt::format("{}: cannot be sent: {:.0f} MB, of which a message has {:.0f}",
                                   file.string(), Megabytes(bytes.size()),
                                   Megabytes(PacketReader::kMaxMessageBytes)));
    }
    Decode<Message>(bytes, channel);
    return bytes.size();
  } catch (const MessageError& error) {
    throw InputError(fmt::format("{}: cannot be sent: {}", file.string(), error.what()));
  }
}

}  // namespace

std::string DescribeIndices(const std::vector<ProblemFiles>& problems) {
  std::vector<std::string> ranges;
  for (std::size_t i = 0; i < problems.size();) {
    std::size_t last = i;
    while (last + 1 < problems.size() && problems[last + 1].index == problems[last].index + 1) {
      ++last;
    }
    ranges.push_back(last == i ? fmt::format("{}", problems[i].index)
                               : fmt::format("{}-{}", problems[i].index, problems[last].index));
    i = last + 1;
  }
  return fmt::format("{}", fmt::join(ranges, ", "));
}

ProblemLibrary::ProblemLibrary(const Robot& robot, const std::vector<fs::path>& folders,
                               std::size_t receive_buffer_bytes, const Robot* mesh_robot)
    : robot_(&robot), mesh_robot_(mesh_robot), receive_buffer_bytes_(receive_buffer_bytes) {
  if (folders.empty()) throw InputError("--problems: at least one folder of problems is needed");
  try {
    for (const fs::path& folder : folders) {
      for (const fs::path& set_folder : SetFolders(folder)) AddSet(set_folder);
    }
  } catch (const fs::filesystem_error& error) {
    throw InputError(fmt::format("{}: {}", error.path1().string(), error.code().message()));
  }
  for (const auto& [name, set] : sets_) {
    try {
      Read(set, set.problems.front());
    } catch (const InputError& error) {
      spdlog::error("{}", error.what());
    }
  }
}

void ProblemLibrary::AddSet(const fs::path& folder) {
  ProblemSet set = ListProblemSet(folder);
  const std::string name = set.name;
  const auto [existing, added] = sets_.emplace(name, std::move(set));
  if (!added) {
    throw InputError(fmt::format("two problem sets are named '{}': {} and {}", name,
                                 existing->second.folder.string(), folder.string()));
  }
}

ServedProblem ProblemLibrary::Find(const std::string& set_name, int index) {
  const auto set = sets_.find(set_name);
  if (set == sets_.end()) {
    std::vector<std::string> known;
    for (const auto& [name, other] : sets_) known.push_back(name);
    throw InputError(
        fmt::format("no problem set '{}'; known are: {}", set_name, fmt::join(known, ", ")));
  }
  const ProblemFiles* files = set->second.Find(index);
  if (files == nullptr) {
    throw InputError(fmt::format("problem set '{}' has no problem {}; it has {}", set_name, index,
                                 DescribeIndices(set->second.problems)));
  }
  const std::scoped_lock lock(mutex_);
  return Read(set->second, *files);
}

void ProblemLibrary::RequireUnchanged(const std::string& what, const std::string& id) {
  if (ids_.emplace(what, id).first->second == id) return;
  throw InputError(fmt::format("{} has changed since the server started; start it again", what));
}

std::string ProblemLibrary::TextOf(const fs::path& file) {
  std::string text;
  try {
    RequireProblemFiles(file, file);
    text = ReadText(file);
  } catch (const InputError&) {
    ids_.emplace(file.string(), kUnreadable);
    throw;
  }
  ContentHash hash;
  hash.Add(text);
  RequireUnchanged(file.string(), hash.HexDigest());
  return text;
}

std::string ProblemLibrary::ContentId(const ProblemSet& set) {
  const std::scoped_lock lock(mutex_);
  ContentHash hash;
  for (const ProblemFiles& files : set.problems) {
    hash.Add(files.index);
    try {
      bool has_meshes = false;
      for (const fs::path& file : {files.scene, files.request}) {
        const std::string text = TextOf(file);
        hash.Add(text);
        has_meshes |= MayHaveMesh(text);
      }
      // They may be in other files.
      if (has_meshes) hash.Add(Read(set, files).message.scene_id);
    } catch (const InputError& error) {
      // Whoever asks for this problem is told; the others can be served. Once it has been mended it
      // is another than the id stands for.
      ids_.emplace(NamedBy(files), kUnreadable);
      spdlog::warn("{}", error.what());
    }
  }
  return hash.HexDigest();
}

std::shared_ptr<const Scene> ProblemLibrary::FindScene(const std::string& scene_id) {
  const std::scoped_lock lock(mutex_);
  if (scenes_.count(scene_id) == 0) ReadAll();
  const auto found = scenes_.find(scene_id);
  return found == scenes_.end() ? nullptr : found->second.scene;
}

const ServedProblem& ProblemLibrary::Read(const ProblemSet& set, const ProblemFiles& files) {
  const std::pair key(set.name, files.index);
  if (const auto known = problems_.find(key); known != problems_.end()) return known->second;

  // The texts that the ids are of, whatever is written meanwhile.
  const YamlNode scene_file = YamlNode::Parse(TextOf(files.scene), files.scene.string());
  const YamlNode request_file = YamlNode::Parse(TextOf(files.request), files.request.string());
  Problem problem = ParseProblem(scene_file, request_file, *robot_,
                                 {files.scene.parent_path(), robot_->resources.packages});
  ServedProblem served;
  served.message.problem_set = set.name;
  served.message.problem_index = files.index;
  served.message.scene_id = SceneId(problem.scene);
  RequireUnchanged(NamedBy(files), served.message.scene_id);
  // Problems that differ only in their query share the scene.
  auto known_scene = scenes_.find(served.message.scene_id);
  if (known_scene == scenes_.end()) {
    const Scene meshless = WithoutMeshes(problem.scene);
    const std::size_t bytes = RequireDeliverable(
        SceneMessage{"", SceneId(meshless), true, "", meshless}, channel::kScene, files.scene);
    auto scene = std::make_shared<const Scene>(std::move(problem.scene));
    known_scene =
        scenes_.emplace(served.message.scene_id, KnownScene{std::move(scene), bytes}).first;
  }
  served.scene = known_scene->second.scene;
  if (const std::size_t bytes = known_scene->second.bytes; bytes > receive_buffer_bytes_) {
    problem.warnings.insert(
        problem.warnings.begin(),
        fmt::format("{}: the scene is a message of {:.1f} MB, and receive buffers hold {:.1f} MB: "
                    "it may come late, or never; raise recv_buf_size of every process's --lcm-url, "
                    "and net.core.rmem_max, or make it smaller",
                    files.scene.string(), Megabytes(bytes), Megabytes(receive_buffer_bytes_)));
  }
  for (const std::string& warning : problem.warnings) spdlog::warn("{}", warning);
  served.message.message = Summary(problem.warnings);
  // Told beside the first of the others: verdicts depend on it.
  if (const std::string misfits = PostureMisfitsOf(problem); !misfits.empty()) {
    const std::string misfit = fmt::format("{}: --referee-robot judges it in another posture: {}",
                                           files.request.string(), misfits);
    spdlog::warn("{}", misfit);
    std::string& told = served.message.message;
    told = told.empty() ? misfit : fmt::format("{}; {}", misfit, told);
  }
  served.message.group = problem.group;
  served.message.start = problem.start;
  served.message.goal = problem.goal;
  served.message.time_limit_s = problem.time_limit_s;
  RequireDeliverable(served.message, channel::kProblem, files.request);
  return problems_.emplace(key, std::move(served)).first->second;
}

std::string ProblemLibrary::PostureMisfitsOf(const Problem& problem) const {
  if (mesh_robot_ == nullptr) return "";
  return PostureMisfits(
      robot_->model,
      FullPositionsWherePossible(robot_->model, problem.start.names, problem.start.positions),
      mesh_robot_->model);
}

void ProblemLibrary::ReadAll() {
  if (all_read_) return;
  all_read_ = true;
  for (const auto& [name, set] : sets_) {
    for (const ProblemFiles& files : set.problems) {
      try {
        Read(set, files);
      } catch (const InputError& error) {
        spdlog::warn("{}", error.what());
      }
    }
  }
}

}  // namespace planbench
