#pragma once
#include <functional>
#include <optional>
#include <utility>

#include "nodes/web/connection.h"

namespace dmise {

using HttpAnswer = http::response<http::string_body>;

/// Sends the answers of one connection, piece by piece: a client has the time for each piece, not
/// for the whole.
class AnswerSender {
 public:
  /// `stream`, the connection's, must outlive it.
  AnswerSender(beast::tcp_stream& stream, double piece_within_s)
      : stream_(stream), piece_within_s_(piece_within_s) {}

  /// Calls `next` when all is sent and the connection is kept alive; else closes its end. `next`
  /// holds the connection.
  void send(HttpAnswer answer, std::function<void()> next) {
    answer_ = std::move(answer);
    rest_.emplace(answer_);
    write(std::move(next));
  }

 private:
  void write(std::function<void()> next) {
    stream_.expires_after(milliseconds_of(piece_within_s_));
    http::async_write_some(stream_, *rest_,
                           [this, next = std::move(next)](error_code error, std::size_t) mutable {
                             if (error) return;
                             if (!rest_->is_done()) return write(std::move(next));
                             if (answer_.keep_alive()) return next();
                             error_code ignored;
                             stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
                           });
  }

  beast::tcp_stream& stream_;
  double piece_within_s_;
  HttpAnswer answer_;
  std::optional<http::response_serializer<http::string_body>> rest_;  // writes the answer
};

}  // namespace dmise
