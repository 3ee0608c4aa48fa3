#include "report/recorded_views.h"

#include <gtest/gtest.h>

#include <filesystem>

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

}  // namespace
}  // namespace planbench
