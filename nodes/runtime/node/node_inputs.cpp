#include "nodes/runtime/node/node_inputs.h"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "dmise/v1/node.pb.h"
#include "nodes/runtime/process/json_log.h"
#include "nodes/runtime/process/monotonic_clock.h"

namespace dmise {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;

constexpr milliseconds gap_patience{20};            // for messages known to be published
constexpr milliseconds gap_patience_limit{4000};    // doubled whenever they were only late
constexpr milliseconds quiet_patience{500};         // for others: their publisher may be slow
constexpr milliseconds quiet_patience_limit{8000};  // doubled each time up to this
constexpr milliseconds inputs_idle{1000};

}  // namespace

NodeInputs::NodeInputs(zmq::context_t& context, std::vector<std::string> topics,
                       const Security& security)
    : context_(context),
      security_(security),
      topics_(topics),
      inbox_(std::move(topics)),
      subscribe_(make_socket(context, zmq::socket_type::sub, max_data_bytes)),
      broker_(subscribe_),
      quiet_(quiet_patience),
      gap_(gap_patience) {
  for (const std::string& topic : topics_) subscribe_.set(zmq::sockopt::subscribe, topic);
}

bool NodeInputs::consumes(const std::string& topic) const {
  return std::find(topics_.begin(), topics_.end(), topic) != topics_.end();
}

void NodeInputs::connect(const v1::Topology& topology) {
  for (const auto& publisher : topology.publishers()) follow(publisher);
  broker_.follow(topology.subscribe_endpoint(), topology.broker_incarnation(), security_,
                 topology.broker_password());
  list_sockets();
}

void NodeInputs::follow(const v1::Publisher& publisher) {
  std::vector<std::string> topics, direct;
  for (const std::string& topic : publisher.topics())
    if (consumes(topic)) topics.push_back(topic);
  for (const std::string& topic : publisher.direct_topics())
    if (consumes(topic)) direct.push_back(topic);
  topics.insert(topics.end(), direct.begin(), direct.end());
  if (topics.empty()) return;
  Source& source = sources_[publisher.name()];
  if (source.incarnation == publisher.incarnation()) return;
  const bool follows_another = source.incarnation != 0;
  source = {publisher.incarnation(), publisher.resend_endpoint(), {}, {}};
  for (const std::string& topic : topics) {
    receiver_->allow(topic, publisher.name(), publisher.incarnation());
    publisher_of_[topic] = publisher.name();
    inbox_.set_schedule(
        topic, {std::max<Tick>(1, Tick(publisher.period_ticks())), Tick(publisher.offset_ticks())});
    for (const auto& own : publisher.schedules())
      if (own.topic() == topic)
        inbox_.set_schedule(topic, {Tick(own.period_ticks()), Tick(own.offset_ticks())});
    if (!follows_another) continue;
    inbox_.restart(topic);
    asked_ = nanoseconds{0};  // request its position without delay
  }
  if (!direct.empty()) {
    source.direct = make_socket(context_, zmq::socket_type::sub, max_data_bytes);
    for (const std::string& topic : direct) source.direct->set(zmq::sockopt::subscribe, topic);
    connect_to(*source.direct, publisher.direct_endpoint(), security_, publisher.name());
  }
}

void NodeInputs::list_sockets() {
  sockets_.clear();
  if (broker_.known() && !topics_.empty()) sockets_.push_back(&subscribe_);
  for (auto& [name, source] : sources_)
    for (auto* socket : {&source.direct, &source.asker})
      if (*socket) sockets_.push_back(&**socket);
}

void NodeInputs::begin_at(Tick tick, Tick resumes_at, bool catch_up) {
  inbox_.begin_at(tick, resumes_at, catch_up);
  if (catch_up)
    for (const std::string& topic : topics_) ask(topic, 1, inbox_.begins_at(topic));
  asked_ = now();
}

void NodeInputs::update_topics(const std::vector<v1::ClosedTopic>& closed,
                               const std::vector<v1::TopicTally>& published) {
  for (const auto& topic : closed) inbox_.close(topic.topic(), topic.from_tick());
  for (const auto& tally : published) {
    const auto publisher = publisher_of_.find(tally.topic());
    if (publisher == publisher_of_.end() ||
        sources_.at(publisher->second).incarnation != tally.incarnation())
      continue;
    inbox_.published({tally.topic(), tally.messages(), tally.last_sequence(), tally.digest()},
                     tally.tick());
  }
}

void NodeInputs::receive() {
  if (broker_.known()) receive_from(subscribe_, nullptr, Inbox::Way::broker);
  for (auto& [name, source] : sources_) {
    if (source.direct) receive_from(*source.direct, &name, Inbox::Way::direct);
    if (source.asker) receive_from(*source.asker, &name, Inbox::Way::answer);
  }
  adapt_patience();
  log_forged();
}

void NodeInputs::log_forged() {
  if (inbox_.forged() == forged_said_) return;
  spdlog::warn("dropped {} messages that their publishers have not sent",
               inbox_.forged() - forged_said_);
  forged_said_ = inbox_.forged();
}

/// `publisher`: the only permitted publisher; null: any.
void NodeInputs::receive_from(zmq::socket_t& socket, const std::string* publisher, Inbox::Way way) {
  for (auto message = dmise::receive(socket); !message.empty(); message = dmise::receive(socket)) {
    // A subscription also matches topics with the same prefix.
    const auto expected = publisher_of_.find(message[0].to_string());
    if (expected == publisher_of_.end()) continue;
    if (publisher && expected->second != *publisher) {
      spdlog::warn("refused a message: {} does not publish on {}", *publisher, expected->first);
    } else if (const auto received = receiver_->receive(views(message))) {
      ++received_;
      const bool counts =
          way != Inbox::Way::answer && received->envelope.kind != MessageKind::probe;
      if (counts && lose_every_ > 0 && ++countdown_ % std::uint64_t(lose_every_) == 0) {
        ++lost_;
        continue;
      }
      inbox_.accept(*received, way);
    } else {
      log_event(spdlog::level::warn, "message_refused", {{"topic", expected->first}},
                "refused a message: " + receiver_->last_refusal());
    }
  }
}

nanoseconds NodeInputs::ask_for(Tick tick) {
  const auto wants = inbox_.wanted(tick);
  if (wants.empty()) return inputs_idle;
  const bool gap = std::any_of(wants.begin(), wants.end(), [](const auto& w) { return w.gap; });
  const Missing missing = gap ? Missing::gap : Missing::quiet;
  // Patience starts when a gap is known. 0: request without delay.
  if (missing > missing_ && asked_.count() != 0) asked_ = now();
  missing_ = missing;
  const nanoseconds patience = gap ? std::max(gap_, again_) : quiet_;
  if (now() - asked_ > patience) {
    for (const Inbox::Want& want : wants) {
      asked_for_known_ += want.gap;
      ask(want.topic, want.from_sequence,
          want.from_tick || !may_miss_ ? want.from_tick : std::optional(tick));
    }
    asked_ = now();
    if (gap) duplicates_when_asked_ = inbox_.duplicates();
    if (gap)
      again_ = std::min<nanoseconds>(2 * patience, gap_patience_limit);
    else
      quiet_ = std::min<nanoseconds>(2 * quiet_, quiet_patience_limit);
  }
  return patience;
}

/// A requested message that came twice was only late: a large network takes time, and requests make
/// it slower.
void NodeInputs::adapt_patience() {
  if (!duplicates_when_asked_ || inbox_.duplicates() == *duplicates_when_asked_) return;
  duplicates_when_asked_.reset();
  gap_ = std::min<nanoseconds>(2 * gap_, gap_patience_limit);
}

void NodeInputs::reset_patience() {
  asked_ = now();
  missing_ = Missing::nothing;
  quiet_ = quiet_patience;
  again_ = nanoseconds{0};
  gap_ = std::max<nanoseconds>(gap_patience,
                               gap_ - gap_ / 16);  // decreases when the network is faster again
}

void NodeInputs::ask(const std::string& topic, std::uint64_t from_sequence,
                     std::optional<Tick> from_tick) {
  const auto publisher = publisher_of_.find(topic);
  if (publisher == publisher_of_.end()) return;
  Source& source = sources_.at(publisher->second);
  if (!source.asker) {
    source.asker = make_socket(context_, zmq::socket_type::dealer, max_data_bytes);
    connect_to(*source.asker, source.resend_endpoint, security_, publisher->second);
    list_sockets();
  }
  v1::ResendRequest request;
  request.set_run_id(run_.run_id);
  request.set_topic(topic);
  request.set_from_sequence(from_sequence);
  request.set_catch_up(from_tick.has_value());
  request.set_from_tick(from_tick.value_or(0));
  source.asker->send(to_frame(request), zmq::send_flags::none);
  ++asked_again_;
}

NodeFigures NodeInputs::figures() const {
  NodeFigures figures{.received = received_,
                      .resend_requests = asked_again_,
                      .missed = inbox_.missed(),
                      .queued = inbox_.queued()};
  for (std::size_t i = 0; receiver_ && i < figures.refused.size(); ++i)
    figures.refused[i] = receiver_->refused(Refusal(i));
  return figures;
}

void NodeInputs::close() {
  sockets_.clear();
  sources_.clear();
  subscribe_.close();
}

}  // namespace dmise
