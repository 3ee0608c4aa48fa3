#include "report/recorded_views.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "logger/results_database.h"
#include "messaging/event_log.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/planar_session.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

TEST(RecordedViewsTest, ARecordIsReadWhenItsRunIsShown) {
  const TemporaryFolder folder;
  const PlanarSession by_hand;
  {
    EventLog log(folder / "s.lcmlog", EventLog::Mode::kNew);
    log.Write(PlanarSession::Received(channel::kSession, by_hand.session));
    log.Write(PlanarSession::Received(channel::kScene, by_hand.scene));
    log.Write(PlanarSession::Received(channel::kRunRecord, by_hand.record));
  }
  StoredSession session;
  session.file = folder / "results.sqlite";
  session.run_id = by_hand.record.run_id;
  StoredRun run;
  run.id = 3;
  run.request_id = by_hand.record.request_id;
  const RecordedViews views(session, "", {});
  EXPECT_TRUE(views.View(run, 10).is_object());
  std::filesystem::resize_file(folder / "s.lcmlog", 10);
  ExpectInputError([&] { views.View(run, 10); }, {"s.lcmlog", "was shortened"});
  run.request_id = "another";
  ExpectInputError([&] { views.View(run, 10); }, {"s.lcmlog", "run 3 is not in it"});
}

TEST(EmbedViewsTest, ARunThatCannotBeShownTakesNoOthersAway) {
  const TemporaryFolder folder;
  const PlanarSession by_hand;
  {
    ResultsDatabase database(folder / "results.sqlite");
    EventLog log(folder / "s.lcmlog", EventLog::Mode::kNew);
    database.Store(by_hand.session);
    log.Write(PlanarSession::Received(channel::kSession, by_hand.session));
    log.Write(PlanarSession::Received(channel::kScene, by_hand.scene));
    for (int trial = 1; trial <= 4; ++trial) {
      RunRecordMessage record = by_hand.record;
      record.trial = trial;
      record.request_id = fmt::format("session/shelf/1/ara/forward/{}", trial);
      record.roundtrip_time_s = 1;
      if (trial == 2) record.result.joint_names[0] = "nonsense";  // is shown without its path
      if (trial == 3) record.request.scene_id = "of another log";
      database.Store(record);
      log.Write(PlanarSession::Received(channel::kRunRecord, record));
    }
  }
  const ComparedSessions compared(ReadSessions(folder.path()).sessions);
  const EmbeddedViews views = EmbedViews(compared, 1'000'000, {});
  EXPECT_EQ(views.by_attempt.size(), 3u);
  EXPECT_THAT(views.notes, testing::ElementsAre(testing::AllOf(
                               testing::HasSubstr("attempts without a 3D view: 1; the first: "),
                               testing::HasSubstr("the scene of run 3"))));
}

}  // namespace
}  // namespace planbench
