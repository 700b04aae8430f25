#include "server/static_files.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "proto/events.h"

namespace weft::server {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargestFile = 32 << 20;  // [bytes]

constexpr std::array<std::pair<const char*, const char*>, 13> kTypes = {{
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".mjs", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".json", "application/json"},
    {".map", "application/json"},
    {".wasm", "application/wasm"},
    {".svg", "image/svg+xml"},
    {".png", "image/png"},
    {".jpg", "image/jpeg"},
    {".ico", "image/x-icon"},
    {".txt", "text/plain; charset=utf-8"},
    {".woff2", "font/woff2"},
}};

std::string content_type_of(const fs::path& path) {
  for (const auto& [extension, type] : kTypes)
    if (path.extension() == extension) return type;
  return "application/octet-stream";
}

}  // namespace

StaticFiles::StaticFiles(const std::string& directory) {
  std::error_code error;
  fs::recursive_directory_iterator entry(directory, error), end;
  for (; !error && entry != end; entry.increment(error)) {
    if (entry->path().filename().string().starts_with('.')) {
      entry.disable_recursion_pending();
      continue;
    }
    if (entry->is_symlink(error) || !entry->is_regular_file(error)) continue;
    if (entry->file_size(error) > kLargestFile) continue;
    std::ifstream in(entry->path(), std::ios::binary);
    StaticFile file;
    file.bytes.assign(std::istreambuf_iterator<char>(in), {});
    file.content_type = content_type_of(entry->path());
    file.etag = proto::hash_text(XXH64(file.bytes.data(), file.bytes.size(), 0));
    file.etag.insert(file.etag.begin(), '"');
    file.etag.push_back('"');
    std::string name = entry->path().lexically_relative(directory).generic_string();
    name.insert(name.begin(), '/');
    files_[name] = std::move(file);
  }
}

const StaticFile* StaticFiles::find(const std::string& path) const {
  const auto found = files_.find(path.ends_with('/') ? path + "index.html" : path);
  return found == files_.end() ? nullptr : &found->second;
}

}  // namespace weft::server
