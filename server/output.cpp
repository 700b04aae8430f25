#include "server/output.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/stat.h>
#include <unistd.h>

namespace weft::server {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPrintedBytes = 1 << 20;

/// Owns a file descriptor, and deletes an unfinished file.
class OpenFile {
 public:
  /// @param flags  of open(2), besides those for writing
  OpenFile(std::string path, int flags, mode_t mode)
      : path_(std::move(path)),
        descriptor_(::open(path_.c_str(), O_WRONLY | O_CLOEXEC | flags, mode)) {}
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (unfinished_) ::unlink(path_.c_str());
  }

  bool is_open() const { return descriptor_ >= 0; }
  const std::string& path() const { return path_; }
  void remove_unless_kept() { unfinished_ = true; }
  void keep() { unfinished_ = false; }

  bool write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
      if (count < 0 && errno != EINTR) return false;
      if (count > 0) bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
  }
  bool set_mode(mode_t mode) { return ::fchmod(descriptor_, mode) == 0; }
  /// Some file systems report a full disk only now.
  bool finish() {
    const bool written = ::fsync(descriptor_) == 0 || errno == EINVAL || errno == EROFS;
    const bool closed = ::close(descriptor_) == 0;
    descriptor_ = -1;
    return written && closed;
  }

 private:
  std::string path_;
  int descriptor_;
  bool unfinished_ = false;
};

OutputError failed(const std::string& path) {
  return {path, std::strerror(errno)};
}

void write_in_place(const std::string& path, std::string_view bytes) {
  OpenFile file(path, 0, 0);
  if (!file.is_open() || !file.write(bytes)) throw failed(path);
}

/// @param target  the file to replace, with symbolic links resolved
void replace(const std::string& path, const fs::path& target, std::string_view bytes) {
  OpenFile file(target.string() + "." + std::to_string(::getpid()) + ".part", O_CREAT | O_EXCL,
                0666);
  if (!file.is_open()) throw failed(path);
  file.remove_unless_kept();
  struct stat old {};
  const bool had_mode = ::stat(target.c_str(), &old) == 0;
  if (!file.write(bytes) || (had_mode && !file.set_mode(old.st_mode & 07777)) || !file.finish() ||
      ::rename(file.path().c_str(), target.c_str()) != 0)
    throw failed(path);
  file.keep();
}

}  // namespace

void prepare_standard_streams() {
  // All output of a command is written at once, so that errno of a failure is known.
  static std::array<char, kPrintedBytes> printed;
  std::setvbuf(stdout, printed.data(), _IOFBF, printed.size());
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) >= 0) continue;
    // The lowest free number is this one. Opened in the wrong direction, it fails every use.
    if (::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY) < 0) return;
  }
}

void flush_standard_output() {
  errno = 0;
  const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (written) return;
  const std::string reason = errno != 0 ? std::strerror(errno) : "a part of it was lost";
  std::clearerr(stdout);
  throw OutputError("standard output", reason);
}

void write_file(const std::string& path, std::string_view bytes) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) return write_in_place(path, bytes);
  const fs::path target = fs::exists(status) ? fs::canonical(path, error) : fs::path(path);
  replace(path, error ? fs::path(path) : target, bytes);
}

}  // namespace weft::server
