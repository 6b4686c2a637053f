#include "nodes/runtime/observability/metrics_server.h"

#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <list>
#include <memory>
#include <vector>

#include "core/base/error.h"

namespace dmise {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds without_files{100};  // wait for a free descriptor

struct Client {
  int fd;
  Clock::time_point deadline;
  std::string request, answer;
  std::size_t sent = 0;
};

std::string answer_of(const char* status, const std::string& type, const std::string& body) {
  return std::string("HTTP/1.1 ") + status + "\r\nContent-Type: " + type +
         "\r\nContent-Length: " + std::to_string(body.size()) + "\r\nConnection: close\r\n\r\n" +
         body;
}

std::string refusal(const char* status) {
  return answer_of(status, "text/plain", std::string(status) + "\n");
}

/// The answer to a request, or "" while its head is incomplete.
std::string answer_to(const std::string& request, const std::function<std::string()>& page) {
  if (request.size() > MetricsServer::longest_request)
    return refusal("431 Request Header Fields Too Large");
  if (request.find("\r\n\r\n") == std::string::npos) return "";
  const auto space = request.find(' ');
  const auto end = request.find_first_of(" ?\r", space + 1);
  if (request.substr(0, space) != "GET") return refusal("405 Method Not Allowed");
  if (request.substr(space + 1, end - space - 1) != "/metrics") return refusal("404 Not Found");
  return answer_of("200 OK", "text/plain; version=0.0.4; charset=utf-8", page());
}

/// Reads or writes what is possible; false if the client is finished or gone.
bool serve(Client* client, short events, const std::function<std::string()>& page) {
  if (client->answer.empty()) {
    char buffer[2048];
    const ssize_t size = recv(client->fd, buffer, sizeof buffer, MSG_DONTWAIT);
    if (size < 0) return errno == EAGAIN || errno == EINTR;
    if (size == 0) return false;
    client->request.append(buffer, std::size_t(size));
    client->answer = answer_to(client->request, page);
    if (client->answer.empty()) return true;
  } else if (events & (POLLERR | POLLHUP)) {
    return false;
  }
  const ssize_t size = send(client->fd, client->answer.data() + client->sent,
                            client->answer.size() - client->sent, MSG_DONTWAIT | MSG_NOSIGNAL);
  if (size < 0) return errno == EAGAIN || errno == EINTR;
  client->sent += std::size_t(size);
  return client->sent < client->answer.size();
}

/// Connected clients, the oldest first.
class Clients {
 public:
  ~Clients() {
    for (const Client& client : clients_) close(client.fd);
  }
  void add(int fd) {
    if (clients_.size() >= MetricsServer::max_clients) {
      close(clients_.front().fd);
      clients_.pop_front();
    }
    clients_.push_back({fd, Clock::now() + MetricsServer::client_deadline, {}, {}});
  }
  void poll_with(std::vector<pollfd>* items) const {
    for (const Client& client : clients_)
      items->push_back({client.fd, short(client.answer.empty() ? POLLIN : POLLOUT), 0});
  }
  int wait_ms() const {
    if (clients_.empty()) return -1;
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(clients_.front().deadline - Clock::now());
    return int(std::max<std::int64_t>(0, left.count()));
  }
  /// `items`: those of `poll_with`, in the same order.
  void serve_all(const pollfd* items, const std::function<std::string()>& page) {
    const auto now = Clock::now();
    for (auto client = clients_.begin(); client != clients_.end(); ++items) {
      const bool goes_on =
          now < client->deadline && (items->revents == 0 || serve(&*client, items->revents, page));
      if (!goes_on) close(client->fd);
      client = goes_on ? std::next(client) : clients_.erase(client);
    }
  }

 private:
  std::list<Client> clients_;
};

int listen_at(const std::string& host, int port) {
  addrinfo wanted{}, *found = nullptr;
  wanted.ai_family = AF_UNSPEC;
  wanted.ai_socktype = SOCK_STREAM;
  wanted.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  if (const int code = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &wanted, &found))
    throw Error(gai_strerror(code));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(found, freeaddrinfo);
  const int fd = socket(found->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const int on = 1;
  if (fd >= 0) setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (fd < 0 || bind(fd, found->ai_addr, found->ai_addrlen) != 0 || listen(fd, 128) != 0) {
    const std::string reason = std::strerror(errno);
    if (fd >= 0) close(fd);
    throw Error(reason);
  }
  return fd;
}

int port_of(int listener) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.ss_family == AF_INET6
                   ? reinterpret_cast<const sockaddr_in6*>(&address)->sin6_port
                   : reinterpret_cast<const sockaddr_in*>(&address)->sin_port);
}

}  // namespace

MetricsServer::MetricsServer(const std::string& host, int port, std::function<std::string()> page)
    : page_(std::move(page)), listener_(listen_at(host, port)), port_(port_of(listener_)) {
  thread_ = std::thread([this] { run(); });
}

MetricsServer::~MetricsServer() {
  quit_.set();
  thread_.join();
  close(listener_);
}

void MetricsServer::run() {
  Clients clients;
  Clock::time_point accepts_from{};
  while (!quit_.is_set()) {
    const bool accepts = Clock::now() >= accepts_from;
    std::vector<pollfd> items{{quit_.fd(), POLLIN, 0}, {listener_, short(accepts ? POLLIN : 0), 0}};
    clients.poll_with(&items);
    const int wait_ms = accepts ? clients.wait_ms() : int(without_files.count());
    if (poll(items.data(), items.size(), wait_ms) < 0 && errno != EINTR) return;
    clients.serve_all(items.data() + 2, page_);
    if (!(items[1].revents & POLLIN)) continue;
    const int fd = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (fd >= 0)
      clients.add(fd);
    else if (errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM)
      accepts_from = Clock::now() + without_files;
  }
}

}  // namespace dmise
