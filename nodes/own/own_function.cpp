#include "nodes/own/own_function.h"

#include <memory>
#include <utility>

#include "nodes/wire/envelope.h"

namespace dmise {
namespace {

class OwnFunction : public OwnModel {
 public:
  OwnFunction(ModelFunction function, const ModelBeginning& beginning)
      : function_(std::move(function)),
        node_(beginning.node.name),
        sensor_(beginning.begin.sensor()) {
    v1::OwnNodeRequest request;
    *request.mutable_begin() = beginning.begin;
    request.mutable_begin()->set_schema_version(wire_schema_version);
    request.mutable_begin()->set_node(node_);
    send(request, beginning.more);
    if (!answer()->head.has_ready()) throw Error("its model does not say that it is ready");
  }

 private:
  bool send(const v1::OwnNodeRequest& request, Frames more) override {
    const std::string head = request.SerializeAsString();
    std::vector<std::string_view> frames{head};
    frames.insert(frames.end(), more.begin(), more.end());
    answer_ = std::make_shared<const std::vector<std::string>>(
        function_({.node = node_, .sensor = sensor_, .frames = frames}));
    return true;
  }
  bool send_ahead(const v1::OwnNodeRequest&, Frames) override { return false; }
  std::optional<Answer> answer() override {
    return answer_in({answer_->begin(), answer_->end()}, answer_);
  }

  ModelFunction function_;
  std::string node_, sensor_;
  std::shared_ptr<const std::vector<std::string>> answer_;  // to the last request
};

}  // namespace

ModelStarter functions_in_process(ModelFunction function) {
  return [function = std::move(function)](const ModelBeginning& beginning) {
    return std::make_unique<OwnFunction>(function, beginning);
  };
}

}  // namespace dmise
