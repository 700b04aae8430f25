#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace weft::server {

/// Exit code if output could not be written.
inline constexpr int kOutputFailed = 5;

/// Output that could not be written; what() names the place and the system's reason.
struct OutputError : std::runtime_error {
  OutputError(const std::string& place, const std::string& reason)
      : std::runtime_error(place + ": cannot be written (" + reason + ")") {}
};

/// Makes a write to a closed standard output fail, instead of ending up in the file or socket that
/// is opened next under its number; and turns a vanished reader into a write error instead of the
/// end of the program.
void prepare_standard_streams();

/// Flushes standard output. Throws OutputError if any output since the last call was lost.
void flush_standard_output();

/// A file that grows beside the one that it replaces when it is finished; that one stays as it was,
/// and this one vanishes, if it is destroyed before, or if SIGHUP, SIGINT or SIGTERM ends the
/// program. Anything but a regular file, such as a named pipe, is written
/// directly. All throw OutputError.
class NewFile {
 public:
  explicit NewFile(const std::string& path);
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  ~NewFile();

  void write(std::string_view bytes);
  /// Once, at the end.
  void finish();

 private:
  class OpenFile;
  std::string path_, target_;  ///< as given, and with symbolic links resolved
  bool in_place_ = false;
  std::unique_ptr<OpenFile> file_;
};

/// Writes a whole NewFile. Throws OutputError.
void write_file(const std::string& path, std::string_view bytes);

}  // namespace weft::server
