#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iostream>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "common/command_line.h"
#include "common/error.h"
#include "common/exit_codes.h"
#include "common/write_file.h"
#include "messaging/robot_flags.h"
#include "report/figures.h"
#include "report/merge_sessions.h"
#include "report/output_folder.h"
#include "report/page.h"
#include "report/print_figures.h"
#include "report/recorded_views.h"
#include "report/session_shares.h"
#include "report/tables.h"
#include "results/imported_results.h"
#include "results/ompl_log.h"

namespace planbench {
namespace {

struct Flags {
  std::vector<std::string> sessions;
  std::string out = "report.html";
  std::string csv;
  std::string latex;
  std::string figures;
  std::string merge;
  std::vector<std::string> imports;
  std::vector<std::string> import_names;
  std::string ompl_log;
  RobotFlags robot;
};

void WriteTables(const std::string& folder, const char* extension, const std::vector<Table>& tables,
                 std::string (*format)(const Table&)) {
  if (folder.empty()) return;
  const std::vector<std::string> known = TableNames();
  const auto is_table = [&](const std::string& file) {
    return std::any_of(known.begin(), known.end(),
                       [&](const std::string& name) { return file == name + extension; });
  };
  ReplaceFiles(folder, is_table, [&](const std::filesystem::path& new_folder) {
    for (const Table& table : tables) {
      WriteFile(new_folder / (table.name + extension), format(table));
    }
  });
}

/// What is to stand beside `sessions`, if there are any.
std::vector<StoredSession> ReadImports(const Flags& flags,
                                       const std::vector<StoredSession>& sessions) {
  double time_limit_s = 0;
  std::set<std::string> contestants;
  for (const StoredSession& session : sessions) {
    for (const StoredContestant& one : session.contestants) contestants.insert(one.name);
    for (const StoredRun& run : session.runs)
      time_limit_s = std::max(time_limit_s, run.time_limit_s);
  }
  if (flags.imports.size() != flags.import_names.size()) {
    throw InputError("every --import FILE needs its --as NAME");
  }
  std::vector<StoredSession> imported;
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < flags.imports.size(); ++i) {
    imported.push_back(
        ImportResults(flags.imports[i], flags.import_names[i], time_limit_s, &warnings));
    if (!sessions.empty()) KeepProblems(ProblemsOf(sessions), &imported.back(), &warnings);
  }
  imported = JoinImports(flags.import_names, std::move(imported));
  RequireOtherNames(contestants, imported);
  for (const std::string& warning : warnings) std::cerr << "report: " << warning << "\n";
  return imported;
}

/// Of a session, and of those that it was merged of.
std::set<std::string> RunIdsOf(const StoredSession& session) {
  try {
    std::set<std::string> run_ids = SessionShares::MergedRunIds(session.flags);
    run_ids.insert(session.run_id);
    return run_ids;
  } catch (const InputError& error) {
    throw InputError(session.file.string() + ": " + error.what());
  }
}

std::vector<StoredSession> ReadAll(const Flags& flags) {
  std::vector<StoredSession> sessions;
  std::map<std::string, std::string> places;  // by run id
  for (const std::string& name : flags.sessions) {
    StoredSessions stored = ReadSessions(name);
    if (stored.num_foreign_runs > 0) {
      std::cerr << fmt::format("report: {}: {} runs of other programs are left out (--import)\n",
                               name, stored.num_foreign_runs);
    }
    for (StoredSession& session : stored.sessions) {
      for (const std::string& run_id : RunIdsOf(session)) {
        const auto [place, is_new] = places.emplace(run_id, name);
        if (is_new) continue;
        throw InputError(fmt::format(
            "{} and {} hold the same session, {}, which cannot be compared with itself: name one "
            "of them, or make one of both with --merge",
            place->second, name, run_id));
      }
      sessions.push_back(std::move(session));
    }
  }
  std::vector<StoredSession> imported = ReadImports(flags, sessions);
  std::move(imported.begin(), imported.end(), std::back_inserter(sessions));
  return sessions;
}

/// A log holds one experiment: of several sets each has a file, with the set's name in it.
void WriteOmplLogs(const std::filesystem::path& file, const std::vector<StoredSession>& sessions) {
  std::vector<std::pair<const StoredSession*, std::string>> experiments;
  for (const StoredSession& session : sessions) {
    std::set<std::string> sets;
    for (const StoredRun& run : session.runs) sets.insert(run.problem_set);
    for (const std::string& set : sets) experiments.emplace_back(&session, set);
  }
  if (experiments.empty()) throw InputError("--ompl-log: there are no runs to write");
  int number = 0;
  for (const auto& [session, set] : experiments) {
    std::filesystem::path of_set = file;
    if (experiments.size() > 1) {
      std::string name = set;
      std::replace_if(
          name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
      of_set.replace_filename(fmt::format("{}-{}-{}{}", file.stem().string(), ++number, name,
                                          file.extension().string()));
    }
    WriteFile(of_set, OmplLog(*session, set));
    std::cout << "report: " << of_set.string() << "\n";
  }
}

void MakeReport(const Flags& flags, const std::map<std::string, std::filesystem::path>& packages) {
  std::vector<StoredSession> sessions = ReadAll(flags);
  if (!flags.ompl_log.empty()) WriteOmplLogs(flags.ompl_log, sessions);
  const ComparedSessions compared(std::move(sessions));
  const std::vector<ComparedPair> pairs = ComparePairs(compared);
  const std::vector<Table> tables = AllTables(compared, pairs);
  WriteTables(flags.csv, ".csv", tables, TableCsv);
  WriteTables(flags.latex, ".tex", tables, TableLatex);
  const Json data = FigureData(compared, pairs, tables);
  if (!flags.figures.empty()) PrintFigures(data, flags.figures);
  const EmbeddedViews views = EmbedViews(compared, RoomForViews(data), packages);
  WriteFile(flags.out, ReportPage(data, views));
  for (const std::string& note : views.notes) std::cerr << "report: " << note << "\n";
  std::cout << "report: " << flags.out << "\n";
}

/// Leaves what was there before the merge: an empty folder or, `is_new`, none.
void RemoveMerged(const std::filesystem::path& folder, bool is_new) {
  std::error_code ignored;  // what is left is named when the merge is tried again
  std::vector<std::filesystem::path> made = {folder};
  if (!is_new) made.assign(std::filesystem::directory_iterator(folder, ignored), {});
  for (const std::filesystem::path& path : made) std::filesystem::remove_all(path, ignored);
}

int Run(Flags flags) {
  if (flags.sessions.empty() && flags.imports.empty()) {
    throw InputError("session is required: a session folder, or --import FILE --as NAME");
  }
  const std::map<std::string, std::filesystem::path> packages = flags.robot.Packages();
  if (flags.merge.empty()) {
    MakeReport(flags, packages);
    return kExitOk;
  }
  const bool is_new = !std::filesystem::exists(flags.merge);
  const std::string merged = MergeSessions(flags.sessions, flags.merge);
  flags.sessions = {flags.merge};
  try {
    MakeReport(flags, packages);
  } catch (...) {
    // The same command, mended, finds the folder as it was.
    RemoveMerged(flags.merge, is_new);
    throw;
  }
  std::cout << "report: " << merged << "\n";
  return kExitOk;
}

}  // namespace
}  // namespace planbench

int main(int argc, char** argv) {
  CLI::App app("Makes a page of what sessions measured: one HTML file that opens anywhere.",
               "report");
  planbench::AddVersionFlag(&app);
  planbench::Flags flags;
  app.add_option("session", flags.sessions,
                 "session folders, or results databases; several are compared side by side");
  app.add_option("--out", flags.out, "the page")->capture_default_str();
  app.add_option("--csv", flags.csv,
                 "folder for the tables as CSV, in the place of an earlier report's");
  app.add_option("--latex", flags.latex, "folder for the tables as LaTeX (booktabs), likewise");
  app.add_option(
      "--figures", flags.figures,
      "folder for the figures as SVG (needs node) and PDF (needs rsvg-convert), likewise");
  app.add_option("--merge", flags.merge,
                 "session folder to make of the sessions, which are parts of one: of this the page "
                 "is made");
  app.add_option(
         "--import", flags.imports,
         "results from elsewhere (CSV, OMPL's logs and databases, docs/lineups.md) to stand "
         "beside the sessions; repeatable")
      ->allow_extra_args(false);
  app.add_option("--as", flags.import_names, "name of what the --import before it brings")
      ->allow_extra_args(false);
  flags.robot.AddPackagePaths(&app);
  app.add_option("--ompl-log", flags.ompl_log, "file for the runs as a log of OMPL's benchmarks");
  return planbench::RunCommand(&app, argc, argv, [&] { return planbench::Run(flags); });
}
