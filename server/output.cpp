#include "server/output.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <optional>
#include <sys/stat.h>
#include <unistd.h>

namespace weft::server {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPrintedBytes = 1 << 20;

OutputError failed(const std::string& path) {
  return {path, std::strerror(errno)};
}

/// Paths of unfinished files, which a signal that ends the program takes along; null: a free place.
constinit std::array<std::atomic<const char*>, 4> unfinished_files{};

/// Signals that end a program from outside, as a key or another program does.
constexpr std::array kEndings = {SIGHUP, SIGINT, SIGTERM};

extern "C" void end_without_unfinished_files(int signal) {
  for (const std::atomic<const char*>& place : unfinished_files)
    if (const char* path = place.load()) ::unlink(path);
  ::raise(signal);  // now with its usual effect: SA_RESETHAND
}

/// Leaves signals alone that are ignored or that other code attends to.
void attend_to_endings() {
  for (const int signal : kEndings) {
    struct sigaction action {};
    if (::sigaction(signal, nullptr, &action) != 0 || action.sa_handler != SIG_DFL) continue;
    action.sa_handler = &end_without_unfinished_files;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    ::sigaction(signal, &action, nullptr);
  }
}

/// The place of an unfinished file among these, during its lifetime.
class UnfinishedFile {
 public:
  /// @param path  must live as long; the file need not be there yet
  explicit UnfinishedFile(const char* path) {
    static const bool attends = (attend_to_endings(), true);
    (void)attends;
    for (std::atomic<const char*>& place : unfinished_files) {
      const char* none = nullptr;
      if (!place.compare_exchange_strong(none, path)) continue;
      place_ = &place;
      return;
    }
  }
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;
  ~UnfinishedFile() {
    if (place_) place_->store(nullptr);
  }

 private:
  std::atomic<const char*>* place_ = nullptr;  ///< null: there are too many
};

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

/// Owns a file descriptor, and deletes an unfinished file.
class NewFile::OpenFile {
 public:
  /// Opens what is there already.
  explicit OpenFile(std::string path)
      : path_(std::move(path)), descriptor_(::open(path_.c_str(), O_WRONLY | O_CLOEXEC)) {}
  /// Makes a file that is deleted unless it is kept.
  OpenFile(std::string path, mode_t mode) : path_(std::move(path)) {
    unfinished_.emplace(path_.c_str());
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC | O_CREAT | O_EXCL, mode);
    if (!is_open()) keep();
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (unfinished_) ::unlink(path_.c_str());
    unfinished_.reset();
  }

  bool is_open() const { return descriptor_ >= 0; }
  const std::string& path() const { return path_; }
  void keep() { unfinished_.reset(); }

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
  int descriptor_ = -1;
  std::optional<UnfinishedFile> unfinished_;
};

NewFile::NewFile(const std::string& path) : path_(path), target_(path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  in_place_ = fs::exists(status) && !fs::is_regular_file(status);
  if (in_place_) {
    file_ = std::make_unique<OpenFile>(path);
    if (!file_->is_open()) throw failed(path_);
    return;
  }
  const fs::path resolved = fs::exists(status) ? fs::canonical(path, error) : fs::path(path);
  if (!error) target_ = resolved.string();
  file_ = std::make_unique<OpenFile>(target_ + "." + std::to_string(::getpid()) + ".part", 0666);
  if (!file_->is_open()) throw failed(path_);
}

NewFile::~NewFile() = default;

void NewFile::write(std::string_view bytes) {
  if (!file_->write(bytes)) throw failed(path_);
}

void NewFile::finish() {
  if (in_place_) return;
  struct stat old {};
  const bool had_mode = ::stat(target_.c_str(), &old) == 0;
  if ((had_mode && !file_->set_mode(old.st_mode & 07777)) || !file_->finish() ||
      ::rename(file_->path().c_str(), target_.c_str()) != 0)
    throw failed(path_);
  file_->keep();
}

void write_file(const std::string& path, std::string_view bytes) {
  NewFile file(path);
  file.write(bytes);
  file.finish();
}

}  // namespace weft::server
