#include "core/products/task_fields.h"
#include "dmise/v1/task.pb.h"
#include "nodes/wire/codecs.h"

namespace dmise {
namespace {

void put_task(v1::Task* message, const Task& t) {
#define DMISE_VALUE(field, key, unit) message->set_##field(t.field);
#define DMISE_TIME(field, key) message->set_##field##_ns(t.field.ns);
#define DMISE_LIST(field, ...) message->mutable_##field()->Add(t.field.begin(), t.field.end());
  DMISE_TASK_FIELDS(DMISE_VALUE, DMISE_TIME, DMISE_LIST, DMISE_LIST)
#undef DMISE_VALUE
#undef DMISE_TIME
#undef DMISE_LIST
}

Task take_task(const v1::Task& message) {
  Task t;
#define DMISE_VALUE(field, key, unit) t.field = message.field();
#define DMISE_TIME(field, key) t.field = {message.field##_ns()};
#define DMISE_LIST(field, key, size) t.field = take<size>(message.field(), #field);
#define DMISE_NUMBERS(field, key) t.field.assign(message.field().begin(), message.field().end());
  DMISE_TASK_FIELDS(DMISE_VALUE, DMISE_TIME, DMISE_LIST, DMISE_NUMBERS)
#undef DMISE_VALUE
#undef DMISE_TIME
#undef DMISE_LIST
#undef DMISE_NUMBERS
  return t;
}

}  // namespace

Encoded encode_body(const TaskSet& set) {
  v1::TaskSet message;
  message.set_node(set.node);
  message.set_sensor(set.sensor);
  message.set_tick(set.tick);
  message.set_time_ns(set.time.ns);
  for (const Task& t : set.tasks) put_task(message.add_tasks(), t);
  return {MessageKind::task_set, message.SerializeAsString(), {}};
}

TaskSet decode_tasks(std::string_view payload) {
  const auto message = parse<v1::TaskSet>(payload);
  TaskSet set{.tick = message.tick(),
              .time = {message.time_ns()},
              .node = message.node(),
              .sensor = message.sensor(),
              .tasks = {}};
  set.tasks.reserve(std::size_t(message.tasks_size()));
  for (const auto& t : message.tasks()) set.tasks.push_back(take_task(t));
  return set;
}

}  // namespace dmise
