#include "tests/fuzz/apart.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <execinfo.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <system_error>
#include <thread>
#include <unistd.h>

#include "server/clock.h"
#include "tests/fuzz/run.h"

namespace weft::fuzz {
namespace {

constexpr std::size_t kMostWords = 64 * 1024;
constexpr rlim_t kMostMemory = rlim_t{3} << 30;  // of address space, where no sanitizer needs more

void print_place() {
  std::array<void*, 48> frames;
  ::backtrace_symbols_fd(frames.data(), ::backtrace(frames.data(), frames.size()), STDERR_FILENO);
}

extern "C" void on_alarm(int) {
  constexpr char kText[] = "took longer than it may; it was here:\n";
  (void)!::write(STDERR_FILENO, kText, sizeof kText - 1);
  print_place();
  ::_exit(kHangExit);
}

extern "C" void on_crash(int number) {
  print_place();
  ::signal(number, SIG_DFL);
  ::raise(number);
}

void prepare_child(int words) {
  ::dup2(words, STDERR_FILENO);
  std::signal(SIGPROF, on_alarm);
#ifndef __SANITIZE_ADDRESS__
  const rlimit memory{kMostMemory, kMostMemory};
  ::setrlimit(RLIMIT_AS, &memory);
  // A stack of its own, as what was overrun may be the stack.
  static std::array<char, 1 << 16> stack;
  stack_t other{};
  other.ss_sp = stack.data();
  other.ss_size = stack.size();
  ::sigaltstack(&other, nullptr);
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) {
    struct sigaction action {};
    action.sa_handler = on_crash;
    action.sa_flags = SA_ONSTACK;
    ::sigaction(number, &action, nullptr);
  }
#endif
}

std::string text_of(int file) {
  std::string text(kMostWords, '\0');
  const ssize_t size = ::pread(file, text.data(), text.size(), 0);
  text.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
  return text;
}

}  // namespace

Apart::Apart(const std::function<void()>& work, double wall_seconds)
    : words_(::memfd_create("words", MFD_CLOEXEC)), end_(server::process_seconds() + wall_seconds) {
  process_ = ::fork();
  if (words_ < 0 || process_ < 0) throw std::system_error(errno, std::generic_category());
  if (process_ > 0) return;
  prepare_child(words_);
  work();
  ::_exit(0);
}

Apart::~Apart() {
  if (!waited_) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, &status_, 0);
  }
  ::close(words_);
}

bool Apart::ended() {
  if (waited_) return true;
  waited_ = ::waitpid(process_, &status_, WNOHANG) == process_;
  if (!waited_ && !killed_ && server::process_seconds() > end_) {
    killed_ = true;
    ::kill(process_, SIGKILL);
  }
  return waited_;
}

Ending Apart::ending() {
  while (!ended()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  Ending ending;
  ending.words = text_of(words_);
  if (killed_) {
    ending.kind = Ending::Kind::killed;
    ending.how = "killed, as it did not end";
  } else if (WIFSIGNALED(status_)) {
    ending.kind = Ending::Kind::crashed;
    ending.how = "signal " + std::to_string(WTERMSIG(status_));
  } else if (WEXITSTATUS(status_) == kHangExit) {
    ending.kind = Ending::Kind::hung;
    ending.how = "took longer than it may";
  } else if (WEXITSTATUS(status_) != 0) {
    ending.kind = Ending::Kind::crashed;
    ending.how = "exit code " + std::to_string(WEXITSTATUS(status_));
  }
  return ending;
}

}  // namespace weft::fuzz
