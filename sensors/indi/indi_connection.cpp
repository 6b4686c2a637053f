#include "sensors/indi/indi_connection.h"

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <deque>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/printable.h"
#include "sensors/indi/indi_interest.h"

namespace dmise {

/// One client. What it is sent waits in a queue of texts that clients share.
class IndiConnection : public SocketConnection,
                       public std::enable_shared_from_this<IndiConnection> {
 public:
  IndiConnection(IndiHub& hub, tcp::socket socket)
      : SocketConnection(hub.connections, std::move(socket)), hub_(hub) {
    hub_.clients.push_back(this);
  }
  ~IndiConnection() override { std::erase(hub_.clients, this); }

  void read() {
    if (ends_ || waiting_bytes_ > hub_.options.max_unanswered_bytes) return;
    is_reading_ = true;
    if (interest_.has_asked())
      stream_.expires_never();
    else
      stream_.expires_after(milliseconds_of(hub_.options.request_within_s));
    stream_.async_read_some(boost::asio::buffer(bytes_),
                            [self = shared_from_this()](error_code error, std::size_t size) {
                              self->is_reading_ = false;
                              if (!error) self->hear(std::string_view(self->bytes_.data(), size));
                            });
  }

  const IndiInterest& interest() const { return interest_; }

  void send(std::shared_ptr<const std::string> text) {
    if (ends_) return;
    if (waiting_bytes_ > hub_.options.max_waiting_bytes) {
      ends_ = true;
      return close();
    }
    waiting_bytes_ += text->size();
    waiting_.push_back(std::move(text));
    if (waiting_.size() == 1) write(0);
  }
  void send(std::string text) { send(std::make_shared<const std::string>(std::move(text))); }

 private:
  bool has_access() const override { return interest_.has_asked(); }

  IndiRemark remark(const std::string& message) const {
    return {hub_.observatory.utc(hub_.observatory.now()), printable(message)};
  }

  /// Answers what was read, as long as the client takes the answers; then reads on.
  void hear(std::string_view bytes) {
    try {
      stream_text_.add(bytes);
      while (waiting_bytes_ <= hub_.options.max_unanswered_bytes) {
        const auto element = stream_text_.next();
        if (!element) break;
        if (const auto request = parse_indi(*element)) answer(*request);
      }
    } catch (const BadIndi& error) {
      send(indi_message("", remark(error.what())));
      ends_ = true;  // when that is sent
    } catch (const Error& error) {
      send(indi_message("", remark(error.what())));
    }
    read();
  }

  void answer(const IndiRequest& request) {
    if (const auto* asked = std::get_if<GetIndiProperties>(&request)) {
      interest_.ask(*asked);
      for (const IndiNews& news : hub_.devices.defined(*asked)) send(news.xml);
    } else if (const auto* enabled = std::get_if<EnableIndiBlob>(&request)) {
      interest_.enable(*enabled);
    } else {
      set(std::get<NewIndiVector>(request));
    }
  }

  void set(const NewIndiVector& given) {
    try {
      hub_.tell(hub_.devices.set(given));
    } catch (const DeviceError& error) {  // there is no such property
      return send(indi_message(given.device, remark(error.what())));
    }
    hub_.tell_changes();
  }

  /// Sends the first text that waits, from a byte on, piece by piece: the time is for each piece.
  void write(std::size_t from) {
    stream_.expires_after(milliseconds_of(hub_.options.progress_within_s));
    const std::string& text = *waiting_.front();
    stream_.async_write_some(boost::asio::buffer(text.data() + from, text.size() - from),
                             [self = shared_from_this(), from](error_code error, std::size_t size) {
                               if (error) return self->close();
                               if (from + size < self->waiting_.front()->size())
                                 return self->write(from + size);
                               self->written();
                             });
  }

  void written() {
    waiting_bytes_ -= waiting_.front()->size();
    waiting_.pop_front();
    if (!waiting_.empty()) return write(0);
    if (ends_) return close();
    if (!is_reading_) hear({});
  }

  IndiHub& hub_;
  std::array<char, 16 << 10> bytes_{};
  IndiStream stream_text_;
  IndiInterest interest_;
  std::deque<std::shared_ptr<const std::string>> waiting_;
  std::size_t waiting_bytes_ = 0;
  bool is_reading_ = false, ends_ = false;
};

void IndiHub::tell(const std::vector<IndiNews>& news) {
  for (const IndiNews& item : news) {
    const auto text = std::make_shared<const std::string>(item.xml);
    for (IndiConnection* client : clients)
      if (client->interest().wants(item.device, item.property, item.blob)) client->send(text);
  }
}

void IndiHub::tell_changes() {
  const auto is_wanted = [this](const std::string& device, const std::string& property) {
    return std::ranges::any_of(clients, [&](const IndiConnection* client) {
      return client->interest().wants(device, property, true);
    });
  };
  try {
    tell(devices.changes(is_wanted));
  } catch (const Error& error) {
    const IndiRemark remark{observatory.utc(observatory.now()), printable(error.what())};
    for (IndiConnection* client : clients) client->send(indi_message("", remark));
  }
}

void serve_indi(IndiHub& hub, tcp::socket socket) {
  std::make_shared<IndiConnection>(hub, std::move(socket))->read();
}

}  // namespace dmise
