#pragma once

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

/// Writes a file atomically: into a new one beside it, which then replaces it. On failure the file
/// stays as it was. Anything but a regular file, such as a named pipe, is written directly. Throws
/// OutputError.
void write_file(const std::string& path, std::string_view bytes);

}  // namespace weft::server
