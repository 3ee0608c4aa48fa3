#include "report/trained.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "results/training.h"

namespace planbench {
namespace {

/// Whether whom a table calls so has learned from the set: a contestant, or, of one that is
/// compared with itself (ChangeTable), whichever of that name.
bool IsTrained(const ComparedSessions& compared, const std::string& set, const std::string& name) {
  const auto& all = compared.contestants();
  const auto of_name = [&](std::string ComparedContestant::*member) {
    return std::any_of(all.begin(), all.end(), [&](const ComparedContestant& one) {
      return one.*member == name && IsTrained(compared, set, one);
    });
  };
  return of_name(&ComparedContestant::name) || of_name(&ComparedContestant::own_name);
}

/// What marks whom a table calls so, rows being of no set.
std::string MarkOf(const ComparedSessions& compared, const std::string& name) {
  const auto& all = compared.contestants();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const ComparedContestant& one) { return one.name == name; });
  return found == all.end() ? "" : MarkOf(compared, *found);
}

}  // namespace

bool IsTrained(const ComparedSessions& compared, const std::string& set,
               const ComparedContestant& contestant) {
  const auto& sets = compared.outcomes();
  return std::any_of(sets.begin(), sets.end(), [&](const auto& one) {
    return (set == kAllSets || set == one.first) && one.second.contains(contestant.name) &&
           contestant.IsTrainedOn(one.first);
  });
}

std::vector<std::string> SetsLearnedFrom(const ComparedSessions& compared,
                                         const ComparedContestant& contestant) {
  std::vector<std::string> sets;
  for (const auto& [set, by_contestant] : compared.outcomes()) {
    if (by_contestant.contains(contestant.name) && contestant.IsTrainedOn(set)) sets.push_back(set);
  }
  return sets;
}

std::string MarkOf(const ComparedSessions& compared, const ComparedContestant& contestant) {
  const auto& sets = compared.outcomes();
  const auto num_tried = std::count_if(sets.begin(), sets.end(), [&](const auto& set) {
    return set.second.contains(contestant.name);
  });
  return TrainedMark(SetsLearnedFrom(compared, contestant), static_cast<std::size_t>(num_tried));
}

void MarkTrained(const ComparedSessions& compared, Table* table) {
  const auto is_of_contestants = [](const Column& column) {
    return column.name == "contestant" || column.name == "first" || column.name == "second";
  };
  const bool of_sets = table->columns.front().name == "set";
  const auto begin = std::find_if(table->columns.begin(), table->columns.end(), is_of_contestants);
  const auto first = static_cast<std::size_t>(begin - table->columns.begin());
  const auto end = std::find_if_not(begin, table->columns.end(), is_of_contestants);
  const std::vector<Column> contestants(begin, end);
  bool any = false;
  std::vector<std::vector<Cell>> marks;
  for (const std::vector<Cell>& row : table->rows) {
    std::vector<Cell>& of_row = marks.emplace_back();
    for (std::size_t i = first; i < first + contestants.size(); ++i) {
      const auto& name = std::get<std::string>(row[i]);
      std::string mark;
      if (!of_sets) {
        mark = MarkOf(compared, name);
      } else if (IsTrained(compared, std::get<std::string>(row[0]), name)) {
        mark = kTrained;
      }
      any = any || !mark.empty();
      of_row.emplace_back(std::move(mark));
    }
  }
  if (!any) return;
  std::vector<Column> columns;
  for (const Column& of : contestants) {
    columns.push_back(contestants.size() == 1
                          ? Column{"trained", "trained"}
                          : Column{of.name + "_trained", of.heading + " trained"});
  }
  const auto place = static_cast<std::ptrdiff_t>(first + contestants.size());
  table->columns.insert(table->columns.begin() + place, columns.begin(), columns.end());
  for (std::size_t i = 0; i < marks.size(); ++i) {
    std::vector<Cell>& row = table->rows[i];
    row.insert(row.begin() + place, marks[i].begin(), marks[i].end());
  }
  table->note += std::string(" ") + (of_sets ? kTrainedNote : kTrainedOnNote);
}

}  // namespace planbench
