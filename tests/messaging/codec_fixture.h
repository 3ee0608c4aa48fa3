#pragma once

#include <gtest/gtest.h>

#include <cstdlib>

#include "messaging/codec.h"
#include "tests/messaging/message_examples.h"
#include "tests/support/temporary_folder.h"

namespace planbench {

using AllMessages =
    testing::Types<DiscoverMessage, NodeStatusMessage, ProblemSetsMessage, ProblemRequestMessage,
                   ProblemMessage, SceneRequestMessage, SceneMessage, PlanRequest, PlanAckMessage,
                   PlanProgressMessage, PlanResultMessage, PlanCancelMessage, AckMessage,
                   CollisionRequestMessage, CollisionReplyMessage, PathCheckRequestMessage,
                   PathCheckReplyMessage, SessionMessage, RunRecordMessage>;

/// A test with a mesh store of its own.
class CodecTest : public testing::Test {
 protected:
  CodecTest() { setenv("PLANBENCH_MESH_STORE", store_.path().c_str(), 1); }
  ~CodecTest() override { unsetenv("PLANBENCH_MESH_STORE"); }

  TemporaryFolder store_;
};

/// What Decode throws for the bytes as (message, request_id); fails the test if it does not throw.
template <typename Message>
MessageError DecodeError(std::span<const std::uint8_t> bytes, const std::string& channel = "CH") {
  try {
    Decode<Message>(bytes, channel);
  } catch (const MessageError& error) {
    return error;
  }
  ADD_FAILURE() << "nothing was thrown; expected a MessageError";
  return {"", ""};
}

}  // namespace planbench
