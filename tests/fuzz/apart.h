#pragma once

#include <functional>
#include <string>
#include <sys/types.h>

namespace weft::fuzz {

/// How a process ended.
struct Ending {
  enum class Kind { well, crashed, hung, killed };
  Kind kind = Kind::well;
  std::string how;    ///< e.g. "signal 11", "exit code 1"
  std::string words;  ///< what it wrote to standard error, at most the first 64 KiB
};

/// Work in a process of its own, so that a crash, a report of a sanitizer or a loop without end
/// ends that process alone.
class Apart {
 public:
  /// Starts it. A signal SIGPROF (of a timer of CPU time that the work sets itself) ends it as
  /// hung, and the place where it was is among its words.
  /// @param wall_seconds  after which it is killed, however little it has computed
  Apart(const std::function<void()>& work, double wall_seconds);
  ~Apart();
  Apart(const Apart&) = delete;
  Apart& operator=(const Apart&) = delete;

  /// Whether it has ended; to be asked now and then.
  bool ended();
  /// How it ended; waits for that.
  Ending ending();

 private:
  pid_t process_ = -1;
  int words_ = -1;  ///< a file without a name
  double end_ = 0;  ///< of its patience [s]
  bool killed_ = false, waited_ = false;
  int status_ = 0;
};

}  // namespace weft::fuzz
