#include "benchmark_driver/failure_list.h"

#include <fmt/format.h>

#include <map>
#include <vector>

#include "benchmark_driver/text_table.h"
#include "results/reason_count.h"

namespace planbench {
namespace {

struct Failures {
  int num_runs = 0;
  std::map<int, int> by_problem;
  ReasonCount reasons;
};

}  // namespace

std::string FailureSummary(const SessionResults& results) {
  std::string text;
  for (const SetResults& set : results.sets()) {
    for (const ContestantResults& one : set.contestants) {
      std::map<PlanStatus, Failures> by_status;
      for (const RunRow* run : one.runs) {
        if (run->confirmed()) continue;
        Failures& failures = by_status[run->status];
        ++failures.num_runs;
        ++failures.by_problem[run->problem_index];
        failures.reasons.Add(*run->message);
      }
      for (const auto& [status, failures] : by_status) {
        std::string line =
            fmt::format("  {}, {}: {} {}, problem{}", set.name, one.label(), failures.num_runs,
                        EnumName(status), failures.by_problem.size() > 1 ? "s" : "");
        for (const auto& [problem, count] : failures.by_problem)
          line += fmt::format(" {}", problem);
        text += Shortened(line) + "\n";
        if (const std::string reason = failures.reasons.Summary(); !reason.empty()) {
          text += BreakLines(Shortened(reason, kLongText), 4);
        }
      }
    }
  }
  return text.empty() ? "" : "Attempts without a confirmed path\n" + text + "\n";
}

std::string FailureList(const SessionResults& results) {
  TextTable table("Attempts without a confirmed path",
                  {"problem", "contestant", "direction", "trial", "status", "reason"}, 6);
  bool any = false;
  for (const SetResults& set : results.sets()) {
    bool any_of_set = false;
    for (const ContestantResults& one : set.contestants) {
      for (const RunRow* run : one.runs) {
        if (run->confirmed()) continue;
        if (!any_of_set) table.AddHeading(set.name);
        any = any_of_set = true;
        table.Add({fmt::format("{}", run->problem_index), one.label(),
                   std::string(EnumName(run->direction)), fmt::format("{}", run->trial),
                   std::string(EnumName(run->status)), *run->message});
      }
    }
  }
  return any ? table.Format("\n") : "";
}

}  // namespace planbench
