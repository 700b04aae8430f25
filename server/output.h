#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace weft::server {

/// Exit code where output could not be written.
inline constexpr int kOutputFailed = 5;

/// Output that could not be written; what() names the place and the system's reason.
struct OutputError : std::runtime_error {
  OutputError(const std::string& place, const std::string& reason)
      : std::runtime_error(place + ": cannot be written (" + reason + ")") {}
};

/// Makes sure that a write to standard output fails where it is closed, and does not go into
/// whatever file or socket is opened next under its number; and that a reader who is gone is an
/// error of the write and not the end of the program.
void prepare_standard_streams();

/// Sends off what was printed. Throws OutputError if any of it did not arrive, since the last call.
void flush_standard_output();

/// Writes a file in one piece: into a new one beside it, which then takes its place. Where that
/// fails, the file is what it was. What is no regular file, as a pipe with a name, is written as it
/// is. Throws OutputError.
void write_file(const std::string& path, std::string_view bytes);

}  // namespace weft::server
