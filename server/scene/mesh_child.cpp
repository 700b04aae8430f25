#include "server/scene/mesh_child.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <limits>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/error.h"
#include "server/clock.h"
#include "server/descriptor.h"
#include "server/scene/sandbox.h"

namespace weft::server {
namespace {

constexpr double kMostWallSeconds = 30;
constexpr rlim_t kMostProcessorSeconds = 5;
constexpr rlim_t kMostMemory = rlim_t{1} << 30;
constexpr char kGood = 'M', kRefused = 'E';

DefinitionError refused(const std::string& path, const std::string& limit,
                        const std::string& hint = {}) {
  return {"mesh", path.substr(path.rfind('/') + 1), limit, hint};
}

template <class T>
void put(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Takes values from the front of the child's output; false once too few bytes are left.
class Take {
 public:
  explicit Take(std::string_view bytes) : rest_(bytes) {}
  template <class T>
  bool operator()(T& value) {
    if (rest_.size() < sizeof value) return false;
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return true;
  }
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

/// Longest name of a face that the child tells [bytes].
constexpr std::size_t kLongestFace = 200;

std::string packed(const MeshFile& file) {
  std::string out(1, kGood);
  put(out, static_cast<std::uint64_t>(file.mesh.positions.size()));
  put(out, static_cast<std::uint64_t>(file.mesh.triangles.size()));
  put(out, static_cast<std::uint64_t>(file.uv.size()));
  put(out, static_cast<std::uint64_t>(file.corner_uv.size()));
  for (const Vec3d& p : file.mesh.positions)
    for (int axis = 0; axis < 3; ++axis) put(out, p[axis]);
  for (const Triangle& t : file.mesh.triangles) put(out, t);
  for (const auto& uv : file.uv) put(out, uv);
  for (const CornerUv& corners : file.corner_uv) put(out, corners);
  return out + file.flat_face.substr(0, kLongestFace);
}

bool unpack(std::string_view bytes, const MeshFileLimits& limits, MeshFile& file) {
  Take take(bytes);
  std::uint64_t vertices = 0, triangles = 0, uv = 0, corner_uv = 0;
  if (!take(vertices) || !take(triangles) || !take(uv) || !take(corner_uv)) return false;
  if (vertices > limits.vertices || triangles > limits.triangles || (uv != 0 && uv != vertices) ||
      (corner_uv != 0 && (uv == 0 || corner_uv != triangles)))
    return false;
  file.mesh.positions.resize(vertices);
  file.mesh.triangles.resize(triangles);
  file.uv.resize(uv);
  file.corner_uv.resize(corner_uv);
  for (Vec3d& p : file.mesh.positions)
    for (int axis = 0; axis < 3; ++axis)
      if (!take(p[axis])) return false;
  for (Triangle& t : file.mesh.triangles) {
    if (!take(t)) return false;
    for (const Index i : t)
      if (i < 0 || static_cast<std::uint64_t>(i) >= vertices) return false;
  }
  for (auto& point : file.uv)
    if (!take(point)) return false;
  for (CornerUv& corners : file.corner_uv)
    if (!take(corners)) return false;
  file.flat_face = take.rest();
  return file.flat_face.size() <= kLongestFace;
}

pid_t spawn_child(const std::string& path, int input, int output) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  std::string program = "weft", command = kMeshChildCommand, name = path;
  std::array<char*, 4> arguments = {program.data(), command.data(), name.data(), nullptr};
  std::array<char*, 1> environment = {nullptr};
  pid_t child = -1;
  const int error = posix_spawn(&child, "/proc/self/exe", &actions, nullptr, arguments.data(),
                                environment.data());
  posix_spawn_file_actions_destroy(&actions);
  return error == 0 ? child : -1;
}

/// Reads to the end of the stream, at most `most` bytes and until the deadline.
/// @return whether the end came in time
bool read_all(int from, std::size_t most, std::string& bytes) {
  const double deadline = process_seconds() + kMostWallSeconds;
  std::array<char, 65536> buffer;
  while (bytes.size() <= most) {
    const double left = deadline - process_seconds();
    pollfd waiting{from, POLLIN, 0};
    if (left <= 0 || poll(&waiting, 1, static_cast<int>(left * 1000) + 1) == 0) return false;
    const ssize_t count = ::read(from, buffer.data(), buffer.size());
    if (count == 0) return true;
    if (count < 0 && errno != EINTR) return false;
    if (count > 0) bytes.append(buffer.data(), static_cast<std::size_t>(count));
  }
  return false;
}

void limit_resource(decltype(RLIMIT_CPU) resource, rlim_t most) {
  const rlimit limit{most, most};
  setrlimit(resource, &limit);
}

bool write_all(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (count < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

}  // namespace

MeshFile read_mesh_apart(const std::string& path, const MeshFileLimits& limits) {
  if (!is_mesh_file_name(path)) throw refused(path, "a name that ends in .obj, .ply, .stl or .glb");
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat info {};
  if (file.number < 0 || fstat(file.number, &info) != 0 || !S_ISREG(info.st_mode))
    throw refused(path, "a file that can be read");
  if (static_cast<std::uint64_t>(info.st_size) > limits.bytes)
    throw refused(path, "at most " + std::to_string(limits.bytes) + " bytes",
                  "it has " + std::to_string(info.st_size));
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw refused(path, "a file", "no pipe can be made");
  Descriptor from_child(ends[0]), to_parent(ends[1]);
  const pid_t child = spawn_child(path, file.number, to_parent.number);
  if (child < 0) throw refused(path, "a file", "no process can be made for it");
  to_parent.close_now();
  const std::size_t most = 64 + kLongestFace + limits.vertices * 40 + limits.triangles * 60;
  std::string answer;
  const bool ended = read_all(from_child.number, most, answer);
  if (!ended) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (ended && !answer.empty() && answer[0] == kRefused) {
    const std::size_t line = answer.find('\n');
    throw refused(path, answer.substr(1, std::min<std::size_t>(line - 1, 200)),
                  line == answer.npos ? "" : answer.substr(line + 1, 200));
  }
  MeshFile mesh;
  const bool good = ended && WIFEXITED(status) && WEXITSTATUS(status) == 0 && !answer.empty() &&
                    answer[0] == kGood && unpack(std::string_view(answer).substr(1), limits, mesh);
  if (!good)
    throw refused(path, "a mesh file that can be parsed",
                  "its parser took too long, too much memory, or failed");
  return mesh;
}

int run_mesh_child(const std::string& name) {
  limit_resource(RLIMIT_CPU, kMostProcessorSeconds);
  limit_resource(RLIMIT_FSIZE, 0);
  limit_resource(RLIMIT_CORE, 0);
  if (!kSanitized) limit_resource(RLIMIT_AS, kMostMemory);
  std::string bytes, answer;
  std::array<char, 65536> buffer;
  for (ssize_t count = 0; (count = ::read(STDIN_FILENO, buffer.data(), buffer.size())) > 0;) {
    bytes.append(buffer.data(), static_cast<std::size_t>(count));
    if (bytes.size() > kFolderMeshLimits.bytes) return 1;
  }
  forbid_system_calls();
  try {
    answer = packed(read_mesh(bytes, name, kFolderMeshLimits));
  } catch (const DefinitionError& error) {
    answer = kRefused + error.limit + "\n" + error.hint;
  } catch (const std::exception&) {
    return 1;
  }
  const bool written = write_all(answer);
  // Skips the library's destructors, whatever state the file left it in.
  _exit(written ? 0 : 1);
}

}  // namespace weft::server
