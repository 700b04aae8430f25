#pragma once

namespace weft::server {

/// Whether a sanitizer is built in: it needs address space and system calls of its own.
#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif
#else
inline constexpr bool kSanitized = false;
#endif

/// From now on this process may allocate memory, read and write open descriptors, and exit; every
/// other system call fails with EPERM. Does nothing where the kernel, the processor or a sanitizer
/// does not allow it.
/// @return whether the restriction is in force
bool forbid_system_calls();

}  // namespace weft::server
