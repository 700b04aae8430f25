#pragma once

#include <map>
#include <string>

namespace weft::server {

/// A file of the page.
struct StaticFile {
  std::string bytes;
  std::string content_type;
  std::string etag;  ///< quoted
};

/// The page's files, read once at the start: a request selects one by name and never reaches the
/// file system.
class StaticFiles {
 public:
  StaticFiles() = default;

  /// Reads the directory and its subdirectories. Links, hidden files and files above 32 MiB are
  /// left out. An unreadable directory gives no files.
  explicit StaticFiles(const std::string& directory);

  /// @param path  of the request's target without query, e.g. "/" or "/main.js"
  /// @return null if there is no such file
  const StaticFile* find(const std::string& path) const;

  std::size_t size() const { return files_.size(); }

 private:
  std::map<std::string, StaticFile> files_;
};

}  // namespace weft::server
