// The diagnostics of one reading, limited to a readable number.
#pragma once
#include <map>
#include <set>
#include <tuple>

#include "io/read_result.h"

namespace montelux {

// Adds to a list of diagnostics, at most `max_per_file` per severity and file; finish() reports how many were
// omitted. Those with a summary are not counted.
class Reporter {
 public:
  static constexpr int max_per_file = 50;

  Reporter(Diagnostics& out, bool lenient) : out_(&out), lenient_(lenient) {}

  void error(const SourceLocation& where, std::string message, std::string hint = {});
  void warning(const SourceLocation& where, std::string message, std::string hint = {});
  void note(const SourceLocation& where, std::string message, std::string hint = {});
  // An error that is a warning with lenient reading.
  void tolerable(const SourceLocation& where, std::string message, std::string hint = {});
  void add(Diagnostic diagnostic);
  void finish();
  // Whether no call before was for this place of a file: defaults of attributes are copied to many entities. True
  // without a place.
  bool is_first_at(const SourceLocation& where);

  // What a lenient reading tolerated, with counts: complete even if there are too many warnings.
  const std::vector<Omission>& omissions() const { return omissions_; }

  bool lenient() const { return lenient_; }
  int errors() const { return out_->errors(); }

 private:
  struct Count {
    SourceLocation first;
    int reported = 0, left_out = 0;
  };
  Diagnostics* out_;
  bool lenient_;
  std::map<std::pair<std::string, Severity>, Count> counts_;
  std::set<std::tuple<const std::string*, int, int>> places_;
  std::vector<Omission> omissions_;
  std::map<std::string, std::size_t> omission_numbers_;  // by what was omitted
};

}  // namespace montelux
