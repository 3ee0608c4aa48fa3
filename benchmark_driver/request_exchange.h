#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <variant>

#include "messaging/messages.h"

namespace planbench {

/// One request to one planner, from the first time it is sent to its end, as a state machine: told
/// what happens and when, it says what to do. The request is repeated until its result comes, which
/// the planner remembers; once it is cancelled, the cancellation is repeated instead.
class RequestExchange {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// What a lost request or a lost result costs.
  static constexpr std::chrono::milliseconds kRepeatPeriod{250};
  /// Silence after which a live planner counts as not answering.
  static constexpr std::chrono::seconds kAckPatience{10};
  /// How long beyond the time limit the planner may work on the requests of others, ...
  static constexpr std::chrono::seconds kBusyPatience{60};
  /// ... have this one until it is cancelled, and then until the planner is given up.
  static constexpr std::chrono::seconds kResultPatience{15};
  /// How long an interrupted request is cancelled without a result to it.
  static constexpr std::chrono::seconds kCancelPatience{1};
  /// How long a lost planner may have been lost to an interruption that is yet to be heard of: who
  /// ends a job (Slurm at its time limit, systemd) tells all its processes at once.
  static constexpr std::chrono::seconds kInterruptionDelay{1};

  enum class Outcome { kResult, kRefused, kNoAnswer, kInterrupted };
  struct Answer {
    Outcome outcome = Outcome::kNoAnswer;
    /// kResult only. CANCELLED has become TIMED_OUT where it was overdue.
    PlanResultMessage result = {};
    bool overdue = false;      ///< It came after the request had been cancelled for that.
    std::string message = {};  ///< Why, for kRefused and kNoAnswer.
    /// Request sent -> result arrived, or given up; 0: none was sent.
    double roundtrip_time_s = 0;
  };

  struct Acknowledgement {
    PlanAckMessage message;
    std::string working_on;  ///< The request that its process announces to work on; "" if none.
  };
  /// Nothing but that time has passed.
  struct Tick {};
  struct ArrivedResult {
    PlanResultMessage message;
    TimePoint arrival;  ///< At this process; not after `now`.
  };
  /// A result that cannot be used; its request_id may be empty.
  struct UnusableResult {
    std::string request_id;
    std::string why;
  };
  /// A message for the request that was not listened to, since it is from somebody else than the
  /// process asked.
  struct RefusedMessage {
    std::string what;
  };
  /// The caller wants no result any more.
  struct Interruption {};
  /// The process that had the request is gone; only what it sent before may still come. So counts
  /// a result CANCELLED to a request that was not cancelled, which no other result can follow. May
  /// be told again when more is known, with that behind `why`.
  struct PlannerLost {
    std::string why;
  };
  using Event = std::variant<Tick, Acknowledgement, ArrivedResult, UnusableResult, RefusedMessage,
                             Interruption, PlannerLost>;

  /// What to do, the sending at once.
  struct Step {
    bool send_request = false;
    bool send_cancel = false;
    std::optional<Answer> answer;  ///< The end; nothing is to be sent.
  };

  RequestExchange(std::string request_id, double time_limit_s, TimePoint now);

  /// Messages about other requests change nothing but the reason, should no answer come. That the
  /// planner is busy with others excuses it as long as its process announces the same. Not to be
  /// called after the end.
  Step Take(TimePoint now, const Event& event);
  /// When the next thing is to be sent, if nothing else happens.
  TimePoint NextSend() const { return next_send_; }

 private:
  bool Ours(const std::string& request_id) const { return request_id == request_id_; }
  bool Cancelling() const { return cancelled_ || interrupted_; }
  Answer End(Outcome outcome, std::string message, TimePoint now) const;
  std::optional<Answer> Hear(TimePoint now, const Event& event);
  /// The end if interrupted; else that is waited for a while.
  std::optional<Answer> Lose(std::string why, TimePoint when);
  std::optional<Answer> HearAck(TimePoint now, const Acknowledgement& ack);
  std::optional<Answer> LosePatience(TimePoint now);

  std::string request_id_;
  std::chrono::steady_clock::duration time_limit_;
  TimePoint begun_;
  TimePoint sent_;  // the first time since the planner was last busy with others: it has it since
  bool was_busy_ = true;
  TimePoint next_send_;
  TimePoint last_ack_;
  std::string other_request_;  // that it was last busy with
  bool denied_ = false;        // its last word: busy with others, though it announced nothing such
  bool working_ = false;       // on this request, by its word
  std::string what_came_;      // in place of a result, last
  std::string refused_;        // first
  std::optional<TimePoint> cancelled_;  // because it was overdue
  std::optional<TimePoint> interrupted_;
  std::optional<TimePoint> lost_;
  std::string why_lost_;
  bool has_cancelled_ = false;  // the planner, by itself
};

}  // namespace planbench
