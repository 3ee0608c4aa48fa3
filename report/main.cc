#include <fmt/format.h>

#include <iostream>

#include "common/command_line.h"
#include "common/error.h"
#include "common/exit_codes.h"
#include "report/figures.h"
#include "report/merge_sessions.h"
#include "report/page.h"
#include "report/print_figures.h"
#include "report/write_file.h"

namespace planbench {
namespace {

/// A page that is to be sent by mail.
constexpr std::size_t kMostBytesOfViews = 30'000'000;

struct Flags {
  std::vector<std::string> sessions;
  std::string out = "report.html";
  std::string csv;
  std::string latex;
  std::string figures;
  std::string merge;
};

void MakeFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError("cannot make the folder " + folder + ": " + error.message());
}

void WriteTables(const std::string& folder, const char* extension, const std::vector<Table>& tables,
                 std::string (*format)(const Table&)) {
  if (folder.empty()) return;
  MakeFolder(folder);
  for (const Table& table : tables) {
    WriteFile(std::filesystem::path(folder) / (table.name + extension), format(table));
  }
}

int Run(Flags flags) {
  if (!flags.merge.empty()) {
    std::cout << "report: " << MergeSessions(flags.sessions, flags.merge) << "\n";
    flags.sessions = {flags.merge};
  }
  std::vector<StoredSession> sessions;
  for (const std::string& name : flags.sessions) {
    StoredSessions stored = ReadSessions(name);
    if (stored.num_foreign_runs > 0) {
      std::cerr << fmt::format("report: {}: {} runs of other programs are left out\n", name,
                               stored.num_foreign_runs);
    }
    std::move(stored.sessions.begin(), stored.sessions.end(), std::back_inserter(sessions));
  }
  const ComparedSessions compared(std::move(sessions));
  const std::uint64_t seed = BootstrapSeed(compared);
  const std::vector<ComparedPair> pairs = ComparePairs(compared, seed);
  const std::vector<Table> tables = AllTables(compared, pairs, seed);
  WriteTables(flags.csv, ".csv", tables, TableCsv);
  WriteTables(flags.latex, ".tex", tables, TableLatex);
  const Json data = FigureData(compared, pairs, tables);
  if (!flags.figures.empty()) {
    MakeFolder(flags.figures);
    PrintFigures(data, flags.figures);
  }
  WriteFile(flags.out, ReportPage(data, EmbedViews(compared, kMostBytesOfViews)));
  std::cout << "report: " << flags.out << "\n";
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
                 "session folders, or results databases; several are compared side by side")
      ->required();
  app.add_option("--out", flags.out, "the page")->capture_default_str();
  app.add_option("--csv", flags.csv, "folder for the tables as CSV");
  app.add_option("--latex", flags.latex, "folder for the tables as LaTeX (booktabs)");
  app.add_option("--figures", flags.figures,
                 "folder for the figures as SVG (needs node) and PDF (needs rsvg-convert)");
  app.add_option("--merge", flags.merge,
                 "session folder to make of the sessions, which are parts of one: of this the page "
                 "is made");
  return planbench::RunCommand(&app, argc, argv, [&] { return planbench::Run(flags); });
}
