#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace weft::server {

/// One form of a file's content.
struct FileContent {
  std::string encoding;  ///< of HTTP: "br", "gzip", or empty for the file as it is
  std::string bytes;
  std::string etag;  ///< quoted; another for each form
};

/// A file of the page.
struct StaticFile {
  std::string content_type;
  FileContent plain;                    ///< the file as it is
  std::vector<FileContent> compressed;  ///< the same, each by another encoding

  /// The smallest form that a client takes.
  /// @param accepted  the request's Accept-Encoding (RFC 9110 section 12.5.3); may be empty
  const FileContent& content_for(std::string_view accepted) const;
};

/// The page's files, read once at the start: a request selects one by name and never reaches the
/// file system.
class StaticFiles {
 public:
  StaticFiles() = default;

  /// Reads the directory and its subdirectories. Links, hidden files and files above 32 MiB are
  /// left out. `NAME.br` and `NAME.gz` are compressed forms of the file `NAME` beside them, and no
  /// files by themselves. An unreadable directory gives no files.
  explicit StaticFiles(const std::string& directory);

  /// @param path  of the request's target without query, e.g. "/" or "/main.js"
  /// @return null if there is no such file
  const StaticFile* find(const std::string& path) const;

  std::size_t size() const { return files_.size(); }

 private:
  void add_compressed_forms();

  std::map<std::string, StaticFile> files_;
};

}  // namespace weft::server
