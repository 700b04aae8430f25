// How soon the system lets a thread run.

#include "server/thread_priority.h"

#include <cstdint>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "server/constants.h"

namespace weft::server {
namespace {

/// The kernel's `sched_attr`, in its first version: the C library has none, and the header of Linux
/// cannot stand beside that of the library.
struct SchedulingAttributes {
  std::uint32_t size = sizeof(SchedulingAttributes);
  std::uint32_t policy = SCHED_OTHER;
  std::uint64_t flags = 0;
  std::int32_t nice = 0;
  std::uint32_t priority = 0;
  std::uint64_t runtime = 0;  ///< a slice [ns]
  std::uint64_t deadline = 0, period = 0;
};

}  // namespace

void be_prompt() {
  SchedulingAttributes wanted;
  wanted.nice = getpriority(PRIO_PROCESS, 0);
  wanted.runtime = kPromptSlice;
  ::syscall(SYS_sched_setattr, 0, &wanted, 0);  // the same as before if the system knows no slices
}

}  // namespace weft::server
