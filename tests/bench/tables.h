#pragma once

#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/cells.h"
#include "tests/bench/contact_cases.h"
#include "tests/bench/contact_speed.h"
#include "tests/bench/kernels.h"
#include "tests/bench/parts.h"
#include "tests/bench/real_time.h"
#include "tests/bench/shaking.h"
#include "tests/bench/threads.h"

namespace weft::bench {

/// A table of comma-separated values, one line a row. Texts that need it are quoted.
class Csv {
 public:
  /// Throws std::runtime_error if the file cannot be made.
  Csv(const std::string& path, const std::vector<std::string>& columns);

  template <class... Values>
  void row(const Values&... values) {
    std::size_t n = 0;
    (write(values, n++), ...);
    end_row(n);
  }

 private:
  void write(const std::string& text, std::size_t n);
  void write(const char* text, std::size_t n) { write(std::string(text), n); }
  void write(double value, std::size_t n);
  void write(int value, std::size_t n) { write(std::to_string(value), n); }
  void end_row(std::size_t count);

  std::ofstream file_;
  std::size_t columns_;
};

/// What else runs on the machine, by the kernel's count.
std::string load_average();

/// The tables of the report, into a directory.
class Tables {
 public:
  /// @param commit  written into each row
  Tables(const std::string& directory, const std::string& commit);

  /// @param cpu_seconds  of the whole run; 0 before it
  void write_machine(const std::string& load_at_start, double cpu_seconds);
  void add_case(const CaseResult& result);
  /// @param coarse,fine  the same scene and fabric with N and 2N particles a side
  void add_spatial(const CaseResult& coarse, const CaseResult& fine);
  void write_kernels(const std::vector<KernelFigure>& figures);
  void write_parts(const std::vector<PartFigure>& figures);
  void write_real_time(const std::vector<RealTimeFigure>& figures);
  void write_threads(const std::vector<ThreadFigure>& figures);
  void write_shaking(const std::vector<ShakingFigure>& figures);
  void write_contact(const std::vector<ContactSpeed>& figures);
  void write_contact_cases(const std::vector<CaseFigure>& figures);

 private:
  /// Of the accuracy, whose rows are written as they come: made anew with the first.
  struct Accuracy {
    explicit Accuracy(const std::string& directory);
    Csv cells, references, spatial;
  };
  Accuracy& accuracy();

  std::string directory_, commit_;
  std::optional<Accuracy> accuracy_;
};

}  // namespace weft::bench
