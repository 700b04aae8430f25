#include "server/commands/version.h"

#include "core/forces/grid_pass.h"
#include "server/version_generated.h"

namespace weft::server {

proto::VersionInfo version_info() {
#ifdef __clang__
  const std::string compiler = "Clang " __clang_version__;
#else
  const std::string compiler = "GNU " __VERSION__;
#endif
  return {WEFT_VERSION, WEFT_COMMIT, compiler, simd_level()};
}

}  // namespace weft::server
