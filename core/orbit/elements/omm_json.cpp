#include <iterator>
#include <nlohmann/json.hpp>

#include "core/base/files/text_fields.h"
#include "core/orbit/elements/omm.h"

namespace dmise {

namespace {

/// Iterator over characters that counts lines.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, int* line) : at_(at), line_(line) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    if (*at_ == '\n') ++*line_;
    ++at_;
    return *this;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
  bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  int* line_;
};

/// SAX handler: objects at the top level, or in the top-level array, are messages.
class MessageHandler : public nlohmann::json_sax<nlohmann::json> {
 public:
  MessageHandler(CatalogueFile& file, const int& line) : file_(file), line_(line) {}

  bool null() override {
    other("null");
    refuse_between_messages("null");
    return true;
  }
  bool boolean(bool flag) override { return scalar(flag ? "true" : "false"); }
  bool number_integer(number_integer_t n) override { return scalar(std::to_string(n)); }
  bool number_unsigned(number_unsigned_t n) override { return scalar(std::to_string(n)); }
  bool number_float(number_float_t, const string_t& text) override { return scalar(text); }
  bool string(string_t& text) override { return scalar(text); }
  bool binary(binary_t&) override { return true; }
  bool key(string_t& name) override {
    if (depth_ == message_depth_) key_ = name;
    return true;
  }
  bool start_object(std::size_t) override {
    if (message_depth_ == 0 && depth_ <= 1) {
      message_depth_ = depth_ + 1;
      first_line_ = line_;
      omm_.clear();
    } else {
      other("an object");
    }
    ++depth_;
    return true;
  }
  bool end_object() override {
    if (depth_ == message_depth_) {
      add_omm(omm_, first_line_, file_);
      message_depth_ = 0;
    }
    --depth_;
    return true;
  }
  bool start_array(std::size_t) override {
    if (message_depth_ == 0 && depth_ == 1)
      file_.refused.push_back({line_, "expected a message, got an array"});
    other("an array");
    ++depth_;
    return true;
  }
  bool end_array() override {
    --depth_;
    return true;
  }
  bool parse_error(std::size_t, const std::string& token,
                   const nlohmann::detail::exception&) override {
    throw ConfigError(at_line(file_.source, line_, "invalid JSON" + got(token)));
  }

 private:
  /// What stands at a key of the message and is no scalar.
  void other(const char* what) {
    if (depth_ == message_depth_ && depth_ > 0) omm_.set_other(key_, what);
  }
  bool scalar(const std::string& text) {
    if (depth_ == message_depth_ && depth_ > 0) omm_.set(key_, text);
    refuse_between_messages(text);
    return true;
  }
  void refuse_between_messages(const std::string& text) {
    if (message_depth_ == 0 && depth_ <= 1)
      file_.refused.push_back({line_, "not a message" + got(text)});
  }

  CatalogueFile& file_;
  const int& line_;
  OmmFields omm_;
  std::string key_;
  int depth_ = 0;          // open objects and arrays
  int message_depth_ = 0;  // where the fields of the message being read are; 0 between messages
  int first_line_ = 1;
};

}  // namespace

void read_omm_json(std::string_view text, CatalogueFile& file) {
  int line = 1;
  MessageHandler handler(file, line);
  const char* end = text.data() + text.size();
  nlohmann::json::sax_parse(CountingIterator(text.data(), &line), CountingIterator(end, &line),
                            &handler);
}

}  // namespace dmise
