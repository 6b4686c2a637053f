#include "core/image/tile_guard.h"

#include <zlib.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "core/base/error.h"
#include "core/image/rice.h"

namespace dmise {
namespace {

constexpr LONGLONG longest_rice_block = 4096;

std::string text_of(const FitsValues& values, const std::string& key) {
  const auto at = values.find(key);
  return at == values.end() ? "" : at->second;
}

LONGLONG whole(const FitsValues& values, const std::string& key, LONGLONG otherwise) {
  const auto at = values.find(key);
  if (at == values.end()) return otherwise;
  return LONGLONG(std::clamp(std::strtod(at->second.c_str(), nullptr), -1e15, 1e15));
}

/// A parameter of the compression (ZNAMEi, ZVALi).
LONGLONG parameter(const FitsValues& values, const std::string& name, LONGLONG otherwise) {
  for (int i = 1; i <= 9; ++i)
    if (text_of(values, "ZNAME" + std::to_string(i)) == name)
      return whole(values, "ZVAL" + std::to_string(i), otherwise);
  return otherwise;
}

/// How an image is cut into tiles; sizes along each axis.
struct Tiling {
  std::vector<LONGLONG> image, tile;
  LONGLONG tiles = 1;

  /// Number of pixels of a tile; those at the ends of an axis are cut off.
  LONGLONG pixels(LONGLONG number) const {
    LONGLONG count = 1;
    for (std::size_t i = 0; i < image.size(); ++i) {
      const LONGLONG along = (image[i] + tile[i] - 1) / tile[i];
      count *= std::min(tile[i], image[i] - number % along * tile[i]);
      number /= along;
    }
    return count;
  }
};

Tiling tiling_of(const FitsValues& values, const std::string& place) {
  const LONGLONG axes = whole(values, "ZNAXIS", 0);
  if (axes < 1 || axes > 6)
    throw ConfigError(place + ": ZNAXIS: must be in 1..6, got " + text_of(values, "ZNAXIS"));
  Tiling out;
  for (LONGLONG i = 1; i <= axes; ++i) {
    const std::string n = std::to_string(i);
    out.image.push_back(whole(values, "ZNAXIS" + n, 0));
    out.tile.push_back(whole(values, "ZTILE" + n, i == 1 ? out.image.back() : 1));
    if (out.tile.back() < 1 || out.tile.back() > out.image.back())
      throw ConfigError(place + ": ZTILE" + n + ": must be in 1..ZNAXIS" + n + ", got " +
                        std::to_string(out.tile.back()));
    out.tiles *= (out.image.back() + out.tile.back() - 1) / out.tile.back();
  }
  if (whole(values, "NAXIS2", 0) != out.tiles)
    throw ConfigError(place + ": NAXIS2: must be the number of tiles, " +
                      std::to_string(out.tiles) + ", got " + text_of(values, "NAXIS2"));
  return out;
}

/// Parameters of RICE_1.
struct RiceForm {
  LONGLONG block = 32, size = 4;
};

RiceForm rice_form(const FitsValues& values, const std::string& place) {
  const RiceForm form{whole(values, "ZVAL1", 32), whole(values, "ZVAL2", 4)};
  if (parameter(values, "BLOCKSIZE", form.block) != form.block ||
      parameter(values, "BYTEPIX", form.size) != form.size)
    throw ConfigError(place + ": ZVAL1: must be BLOCKSIZE, and ZVAL2 BYTEPIX");
  if (form.block < 1 || form.block > longest_rice_block)
    throw ConfigError(place + ": BLOCKSIZE: must be in 1..4096, got " + std::to_string(form.block));
  if (form.size != 1 && form.size != 2 && form.size != 4)
    throw ConfigError(place + ": BYTEPIX: must be 1, 2 or 4, got " + std::to_string(form.size));
  return form;
}

/// Whether gzip bytes hold a tile of `pixels` numbers of 1, 2, 4 or 8 bytes each.
bool gzip_is_whole(std::vector<std::uint8_t>& bytes, std::size_t pixels) {
  z_stream stream{};
  if (inflateInit2(&stream, 15 + 16) != Z_OK) return false;
  stream.next_in = bytes.data();
  stream.avail_in = unsigned(bytes.size());
  std::vector<std::uint8_t> piece(1 << 16);
  int code = Z_OK;
  while (code == Z_OK && stream.total_out <= 8 * pixels) {
    stream.next_out = piece.data();
    stream.avail_out = unsigned(piece.size());
    code = inflate(&stream, Z_NO_FLUSH);
  }
  const std::size_t size = stream.total_out;
  inflateEnd(&stream);
  return code == Z_STREAM_END &&
         (size == pixels || size == 2 * pixels || size == 4 * pixels || size == 8 * pixels);
}

/// Reads the tiles of a column of bytes of variable length.
class TileColumn {
 public:
  /// Number 0 if there is no column of the name.
  TileColumn(Fits& fits, std::string name, LONGLONG extra_bytes, std::string place)
      : fits_(fits), extra_bytes_(extra_bytes), place_(std::move(place)) {
    int type = 0;
    if (fits_get_colnum(fits_.file, CASEINSEN, name.data(), &number_, &fits_.status) != 0) {
      number_ = fits_.status = 0;
      return;
    }
    fits_get_coltype(fits_.file, number_, &type, nullptr, nullptr, &fits_.status);
    if (fits_.status != 0 || type != -TBYTE)
      throw ConfigError(place_ + ": " + name + ": must be a column of bytes of variable length");
  }

  bool is_there() const { return number_ > 0; }
  /// Empty if the column has nothing of this tile, from 0.
  std::vector<std::uint8_t> bytes(LONGLONG tile) {
    LONGLONG count = 0, offset = 0;
    fits_read_descriptll(fits_.file, number_, tile + 1, &count, &offset, &fits_.status);
    if (fits_.status != 0 || count < 0 || offset < 0 || count > extra_bytes_ ||
        offset > extra_bytes_ - count)
      fail(tile, "is not within the file");
    std::vector<std::uint8_t> out(static_cast<std::size_t>(count));
    int any_null = 0;
    if (count > 0)
      fits_read_col(fits_.file, TBYTE, number_, tile + 1, 1, count, nullptr, out.data(), &any_null,
                    &fits_.status);
    if (fits_.status != 0) fail(tile, "can't be read");
    return out;
  }
  [[noreturn]] void fail(LONGLONG tile, const std::string& reason) const {
    throw ConfigError(place_ + ": tile " + std::to_string(tile + 1) + " " + reason);
  }

 private:
  Fits& fits_;
  int number_ = 0;
  LONGLONG extra_bytes_;
  std::string place_;
};

/// A tile is in the first column, or, if it could not be compressed so, by gzip in another.
void require_whole_tiles(Fits& fits, const FitsValues& values, const Tiling& tiling, bool rice,
                         const std::string& place) {
  const RiceForm form = rice ? rice_form(values, place) : RiceForm{};
  const LONGLONG extra_bytes = whole(values, "PCOUNT", 0);
  TileColumn first(fits, "COMPRESSED_DATA", extra_bytes, place);
  TileColumn other(fits, "GZIP_COMPRESSED_DATA", extra_bytes, place);
  if (!first.is_there()) throw ConfigError(place + ": COMPRESSED_DATA: column is missing");
  for (LONGLONG tile = 0; tile < tiling.tiles; ++tile) {
    const auto pixels = std::size_t(tiling.pixels(tile));
    auto bytes = first.bytes(tile);
    bool good = false;
    if (bytes.empty() && other.is_there()) {
      bytes = other.bytes(tile);
      good = gzip_is_whole(bytes, pixels);
    } else {
      good = rice ? rice_is_whole(bytes, std::size_t(form.block), int(form.size), pixels)
                  : gzip_is_whole(bytes, pixels);
    }
    if (!good) first.fail(tile, "can't be unpacked");
  }
}

}  // namespace

void require_harmless_tiles(Fits& fits, const FitsValues& values, const std::string& place) {
  const std::string form = text_of(values, "ZCMPTYPE");
  const bool rice = form == "RICE_1" || form == "RICE_ONE";
  if (!rice && form != "GZIP_1" && form != "GZIP_2")
    throw ConfigError(place + ": ZCMPTYPE: must be RICE_1, GZIP_1 or GZIP_2, got " + form);
  require_whole_tiles(fits, values, tiling_of(values, place), rice, place);
}

}  // namespace dmise
