#include "server/scene/sandbox.h"

#include <array>
#include <cerrno>
#include <cstddef>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>

namespace weft::server {

#if defined(__x86_64__) || defined(__aarch64__)

namespace {

#if defined(__x86_64__)
constexpr unsigned kArchitecture = AUDIT_ARCH_X86_64;
#else
constexpr unsigned kArchitecture = AUDIT_ARCH_AARCH64;
#endif

constexpr std::array kAllowed = {
    SYS_read,           SYS_write,    SYS_brk,    SYS_mmap,   SYS_munmap,        SYS_mremap,
    SYS_madvise,        SYS_mprotect, SYS_futex,  SYS_exit,   SYS_exit_group,    SYS_rt_sigreturn,
    SYS_rt_sigprocmask, SYS_getpid,   SYS_gettid, SYS_tgkill, SYS_clock_gettime, SYS_getrandom};

constexpr sock_filter statement(unsigned code, unsigned value) {
  return {static_cast<unsigned short>(code), 0, 0, value};
}
constexpr sock_filter jump(unsigned value, std::size_t if_equal, std::size_t if_not) {
  return {BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned char>(if_equal),
          static_cast<unsigned char>(if_not), value};
}

}  // namespace

bool forbid_system_calls() {
  if (kSanitized) return false;
  constexpr std::size_t kCalls = kAllowed.size();
  std::array<sock_filter, kCalls + 6> program{};
  program[0] = statement(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, arch));
  program[1] = jump(kArchitecture, 1, 0);
  program[2] = statement(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS);
  program[3] = statement(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr));
  for (std::size_t k = 0; k < kCalls; ++k)
    program[4 + k] = jump(static_cast<unsigned>(kAllowed[k]), kCalls - k, 0);
  program[4 + kCalls] = statement(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM);
  program[5 + kCalls] = statement(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
  const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) == 0;
}

#else

bool forbid_system_calls() {
  return false;
}

#endif

}  // namespace weft::server
