// Where previews of frames come from: the sensors that serve them, or the run's directory.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <future>

#include "core/base/error.h"
#include "core/image/fits_file.h"
#include "core/pictures/picture_file.h"
#include "core/products/frame_report.h"
#include "nodes/gateway/frame_previews.h"
#include "nodes/runtime/node/frame_server.h"
#include "nodes/runtime/transport/socket.h"
#include "tests/image/sample_frame.h"
#include "tests/runtime/key_directory.h"
#include "tests/wire/examples.h"

namespace dmise {
namespace {

constexpr std::uint64_t run_id = 7;
const std::string png = "\x89PNG of the directory";

/// The directory of a run with one preview.
struct RunDirectory {
  RunDirectory() {
    std::filesystem::create_directories(path + "/alpha");
    std::ofstream(path + "/alpha/frame-000003.png") << png;
    std::ofstream(path + "/alpha/frame-000004.png") << "no picture";
  }
  std::string path = testing::TempDir() + "dmise-previews";
};

/// A frame of one bright pixel among 200 x 150.
std::string fits_with_star_at(int column, int row) {
  CountImage counts(200, 150);
  for (int r = 0; r < 150; ++r)
    for (int c = 0; c < 200; ++c) counts.at(c, r) = std::uint16_t(1000 + (c * 7 + r * 13) % 10);
  counts.at(column, row) = 60000;
  return encode_frame(counts, test::sample_header());
}

/// A sensor that serves frames.
struct Sensor {
  explicit Sensor(const std::string& keys = "") : security(keys, keys.empty() ? "" : "alpha") {
    door.emplace(context, security);
    auto socket = FrameServer::make_socket_of(context);
    address = bind_to(socket, "tcp://127.0.0.1:0", security, Domain::data);
    server.emplace(context, std::move(socket), frames, run_id);
  }
  void add(std::uint32_t number, const std::string& fits) {
    FrameReport report{.sensor = "alpha", .frame = number};
    const auto bytes = std::make_shared<const std::string>(fits);
    frames.add(report, [this, bytes] {
      ++loaded;
      return FrameBytes{bytes, *bytes};
    });
  }

  KeptFrames frames{"alpha"};
  std::atomic<int> loaded{0};
  zmq::context_t context{1};
  Security security;
  std::optional<ZapAuthenticator> door;
  std::optional<FrameServer> server;
  std::string address;
};

/// "": there is none.
std::string preview_of(FramePreviews& previews, const std::string& sensor, std::uint32_t frame) {
  auto answered = std::make_shared<std::promise<SharedPreview>>();
  previews.request(sensor, frame,
                   [answered](const SharedPreview& found) { answered->set_value(found); });
  const SharedPreview found = answered->get_future().get();
  return found ? *found : "";
}

TEST(ReadPreview, HasPicturesOfItsSensorsAlone) {
  const RunDirectory run;
  ASSERT_TRUE(read_preview(run.path, "alpha", 3));
  EXPECT_EQ(*read_preview(run.path, "alpha", 3), png);
  EXPECT_FALSE(read_preview(run.path, "alpha", 4));
  EXPECT_FALSE(read_preview(run.path, "alpha", 5));
  for (const char* sensor : {"", ".", "..", "../dmise-previews/alpha", "alpha/../alpha", "beta"})
    EXPECT_FALSE(read_preview(run.path, sensor, 3)) << sensor;
  EXPECT_FALSE(read_preview("", "alpha", 3));
}

TEST(DrawPreview, ShowsTheStarWhereItIs) {
  const auto picture = decode_picture(draw_preview(fits_with_star_at(150, 30)));
  const int scale = picture.columns / 200;
  ASSERT_GE(scale, 1);
  const auto light = [&](int column, int row) {
    const int x = column * scale + scale / 2, y = row * scale + scale / 2;
    return picture.pixels[std::size_t((y * picture.columns + x) * picture.channels)];
  };
  EXPECT_GT(light(150, 30), 0.9f);
  EXPECT_LT(light(30, 150 - 31), 0.5f);
  EXPECT_THROW(draw_preview("no frame"), ConfigError);
}

TEST(FramePreviews, AreDrawnOfWhatTheSensorServes) {
  const RunDirectory run;
  Sensor sensor;
  sensor.add(2, fits_with_star_at(20, 20));
  FramePreviews previews("", "gateway", run.path);
  previews.follow(run_id, {{"alpha", sensor.address}});
  const std::string found = preview_of(previews, "alpha", 2);
  EXPECT_EQ(found, draw_preview(fits_with_star_at(20, 20)));
  EXPECT_EQ(preview_of(previews, "alpha", 2), found);
  EXPECT_EQ(sensor.loaded, 1);                       // it is kept
  EXPECT_EQ(preview_of(previews, "alpha", 3), png);  // not served: of the directory
  EXPECT_EQ(preview_of(previews, "alpha", 9), "");
  EXPECT_EQ(preview_of(previews, "beta", 2), "");
  sensor.add(5, "no frame");
  EXPECT_EQ(preview_of(previews, "alpha", 5), "");
  EXPECT_EQ(preview_of(previews, "alpha", 2), found);
}

TEST(FramePreviews, ManyAreAnsweredInTheirOrder) {
  Sensor sensor;
  for (std::uint32_t frame = 1; frame <= 5; ++frame)
    sensor.add(frame, fits_with_star_at(20 * int(frame), 20));
  FramePreviews previews("", "gateway", "");
  previews.follow(run_id, {{"alpha", sensor.address}});
  std::vector<std::promise<SharedPreview>> answers(30);
  for (std::size_t i = 0; i < answers.size(); ++i)
    previews.request("alpha", std::uint32_t(i % 6), [&answers, i](const SharedPreview& found) {
      answers[i].set_value(std::move(found));
    });
  for (std::size_t i = 0; i < answers.size(); ++i)
    EXPECT_EQ(bool(answers[i].get_future().get()), i % 6 != 0) << i;
}

TEST(FramePreviews, OfASensorThatIsSilentOrGoneAreThoseOfTheDirectory) {
  const RunDirectory run;
  zmq::context_t context;
  zmq::socket_t silent = make_socket(context, zmq::socket_type::router, max_question_bytes);
  const std::string address = bind_to(silent, "tcp://127.0.0.1:0");
  FramePreviews previews("", "gateway", run.path);
  previews.follow(run_id, {{"alpha", address}});
  EXPECT_EQ(preview_of(previews, "alpha", 3), png);
  EXPECT_EQ(preview_of(previews, "alpha", 4), "");
  previews.follow(run_id, {});  // the run is over
  EXPECT_EQ(preview_of(previews, "alpha", 3), png);
}

TEST(FramePreviews, AreEncryptedWhereThereAreKeys) {
  const test::Keys keys({"alpha", "gateway"}), foreign({"alpha", "gateway"});
  Sensor sensor(keys.directory);
  sensor.add(2, fits_with_star_at(20, 20));
  FramePreviews own(keys.directory, "gateway", "");
  own.follow(run_id, {{"alpha", sensor.address}});
  EXPECT_NE(preview_of(own, "alpha", 2), "");
  FramePreviews other(foreign.directory, "gateway", "");
  other.follow(run_id, {{"alpha", sensor.address}});
  EXPECT_EQ(preview_of(other, "alpha", 2), "");
  EXPECT_EQ(sensor.loaded, 1);
}

}  // namespace
}  // namespace dmise
