#include "server/net/static_files.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#define XXH_INLINE_ALL
#include <boost/beast/http/rfc7230.hpp>
#include <xxhash.h>

#include "proto/messages/events.h"

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

struct Compression {
  const char* extension;
  const char* encoding;
};
constexpr std::array<Compression, 2> kCompressions = {{{".br", "br"}, {".gz", "gzip"}}};

FileContent content(std::string encoding, std::string bytes) {
  std::string etag = proto::hash_text(XXH64(bytes.data(), bytes.size(), 0));
  etag.insert(etag.begin(), '"');
  etag.push_back('"');
  return {std::move(encoding), std::move(bytes), std::move(etag)};
}

/// Whether a list such as "gzip, br;q=0.5, *;q=0" allows a coding by its name.
bool accepts(std::string_view list, std::string_view coding) {
  for (const auto& item : boost::beast::http::ext_list({list.data(), list.size()})) {
    if (!boost::beast::iequals(item.first, {coding.data(), coding.size()})) continue;
    for (const auto& [name, value] : item.second)
      if (boost::beast::iequals(name, "q"))
        return value.find_first_not_of("0.") != boost::beast::string_view::npos;
    return true;
  }
  return false;
}

}  // namespace

const FileContent& StaticFile::content_for(std::string_view accepted) const {
  const FileContent* best = &plain;
  for (const FileContent& form : compressed)
    if (form.bytes.size() < best->bytes.size() && accepts(accepted, form.encoding)) best = &form;
  return *best;
}

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
    std::string bytes(std::istreambuf_iterator<char>(in), {});
    StaticFile file{content_type_of(entry->path()), content("", std::move(bytes)), {}};
    std::string name = entry->path().lexically_relative(directory).generic_string();
    name.insert(name.begin(), '/');
    files_[name] = std::move(file);
  }
  add_compressed_forms();
}

void StaticFiles::add_compressed_forms() {
  for (auto file = files_.begin(); file != files_.end();) {
    fs::path name = file->first;
    const auto form =
        std::find_if(kCompressions.begin(), kCompressions.end(),
                     [&](const auto& each) { return name.extension() == each.extension; });
    const auto whole =
        form == kCompressions.end() ? files_.end() : files_.find(name.replace_extension().string());
    if (whole == files_.end()) {
      ++file;
      continue;
    }
    whole->second.compressed.push_back(
        content(form->encoding, std::move(file->second.plain.bytes)));
    file = files_.erase(file);
  }
}

const StaticFile* StaticFiles::find(const std::string& path) const {
  const auto found = files_.find(path.ends_with('/') ? path + "index.html" : path);
  return found == files_.end() ? nullptr : &found->second;
}

}  // namespace weft::server
