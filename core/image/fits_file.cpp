#include "core/image/fits_file.h"

#include <array>
#include <bit>
#include <cstdlib>
#include <vector>

#include "core/base/error.h"
#include "core/base/files/fits_guard.h"
#include "core/base/files/whole_file.h"
#include "core/image/fits_cards.h"
#include "core/image/fits_memory.h"
#include "core/image/plain_image.h"
#include "core/image/rice.h"
#include "core/image/tiled_image.h"
#include "core/wcs/wcs_refraction.h"

namespace dmise {
namespace {

constexpr long widest_side = 1 << 16;
// Rice compresses 32 pixels to a few bits at best: a file that claims more is malicious.
constexpr std::size_t max_pixels_per_byte = 128;

std::array<long, 2> image_shape(Fits& fits, std::size_t file_bytes, const std::string& name) {
  int bits = 0, axes = 0, type = 0;
  std::array<long, 2> shape{};
  fits_get_hdu_type(fits.file, &type, &fits.status);
  if (fits.status == 0 && type == IMAGE_HDU)
    fits_get_img_param(fits.file, 2, &bits, &axes, shape.data(), &fits.status);
  if (fits.status == 0 && axes == 0) {  // empty primary HDU: a compressed image may follow
    fits_movabs_hdu(fits.file, 2, &type, &fits.status);
    if (fits.status != 0 || !fits_is_compressed_image(fits.file, &fits.status))
      throw ConfigError(name + ": NAXIS: contains no image");
    fits_get_img_param(fits.file, 2, &bits, &axes, shape.data(), &fits.status);
  }
  if (fits.status != 0) throw ConfigError(name + ": not a FITS image: " + fits.reason());
  if (axes != 2) throw ConfigError(name + ": NAXIS: must be 2, got " + std::to_string(axes));
  if (bits != SHORT_IMG)
    throw ConfigError(name + ": BITPIX: must be 16, got " + std::to_string(bits));
  for (int i = 0; i < 2; ++i) {
    const long side = shape[std::size_t(i)];
    if (side < 1 || side > widest_side)
      throw ConfigError(name + ": NAXIS" + std::to_string(i + 1) + ": must be in 1..65536, got " +
                        std::to_string(side));
  }
  if (std::size_t(shape[0]) * std::size_t(shape[1]) / max_pixels_per_byte > file_bytes)
    throw ConfigError(name + ": NAXIS1: the image is larger than the file can hold");
  return shape;
}

int integer_of(const FitsValues& values, const std::string& key) {
  const auto at = values.find(key);
  return at == values.end() ? 0 : int(std::strtol(at->second.c_str(), nullptr, 10));
}

/// Decodes a RICE_1 image with one tile per row. CFITSIO's own decoder reads out of bounds on
/// malformed input.
void read_rice(Fits& fits, const FitsValues& values, const std::string& name, CountImage& counts) {
  const auto type = values.find("ZCMPTYPE");
  if (type == values.end() || type->second != "RICE_1")
    throw ConfigError(name + ": ZCMPTYPE: must be RICE_1");
  const int block = integer_of(values, "ZVAL1");
  if (block < 1 || block > 4096 || integer_of(values, "ZVAL2") != 2)
    throw ConfigError(name + ": ZVAL1: must be a block of 1..4096 pixels, of 2 bytes in ZVAL2");
  if (integer_of(values, "ZTILE1") != counts.columns || integer_of(values, "ZTILE2") != 1 ||
      integer_of(values, "NAXIS2") != counts.rows)
    throw ConfigError(name + ": ZTILE1: a tile must be one row");
  int column = 0;
  char label[] = "COMPRESSED_DATA";
  fits_get_colnum(fits.file, CASEINSEN, label, &column, &fits.status);
  std::vector<std::uint8_t> bytes;
  std::vector<std::int16_t> row(static_cast<std::size_t>(counts.columns));
  for (int y = 0; y < counts.rows && fits.status == 0; ++y) {
    LONGLONG size = 0, offset = 0;
    fits_read_descriptll(fits.file, column, y + 1, &size, &offset, &fits.status);
    if (fits.status != 0) break;
    if (size < 0 || size > 4LL * counts.columns + 64)
      throw ConfigError(name + ": row " + std::to_string(y) + " can't be unpacked");
    bytes.resize(std::size_t(size));
    int any_null = 0;
    fits_read_col(fits.file, TBYTE, column, y + 1, 1, size, nullptr, bytes.data(), &any_null,
                  &fits.status);
    if (fits.status != 0 || !rice_decode(bytes, std::size_t(block), row))
      throw ConfigError(name + ": row " + std::to_string(y) + " can't be unpacked");
    for (int x = 0; x < counts.columns; ++x)
      counts.at(x, y) = std::uint16_t(row[std::size_t(x)] + 32768);
  }
  if (fits.status != 0) throw ConfigError(name + ": pixels can't be read: " + fits.reason());
}

void require_unsigned_counts(const FitsValues& values, const std::string& name) {
  const auto bzero = values.find("BZERO");
  if (bzero == values.end()) throw ConfigError(name + ": BZERO: is missing");
  if (std::strtod(bzero->second.c_str(), nullptr) != 32768.0)
    throw ConfigError(name + ": BZERO: must be 32768, got " + bzero->second);
  const auto bscale = values.find("BSCALE");
  if (bscale != values.end() && std::strtod(bscale->second.c_str(), nullptr) != 1.0)
    throw ConfigError(name + ": BSCALE: must be 1, got " + bscale->second);
}

/// Cards that name the bits of a pixel's flags.
std::vector<std::string> flag_cards(const FrameHeader& header) {
  std::vector<std::string> cards = {text_card("EXTNAME", "FLAGS", "what befell each pixel"),
                                    text_card("INSTRUME", header.sensor, "sensor"),
                                    integer_card("FRAMENUM", header.frame, "")};
  for (const auto& [flag, name] : pixel_flag_names) {
    const int bit = std::countr_zero(std::uint8_t(flag));
    cards.push_back(
        text_card("FLAG" + std::to_string(bit), name, "value " + std::to_string(int(flag))));
  }
  return cards;
}

std::vector<std::string> frame_cards(const CountImage& counts, const FrameHeader& header,
                                     const FlagImage* flags) {
  if (flags && (flags->columns != counts.columns || flags->rows != counts.rows))
    throw Error("FITS can't be written: flags and counts differ in size");
  auto cards = fits_cards(header);
  cards.insert(cards.begin(), text_card("BUNIT", "adu", "unit of the pixels: counts of the ADC"));
  return cards;
}

/// Writes the distortion tables along both axes, for readers that know CPDISj = 'LOOKUP'. astropy
/// computes the node of a pixel as (pixel - CRVAL) / CDELT + CRPIX with both counted from 0.
void put_shift_tables(const ByteSink& file, const CountImage& counts, const Wcs& wcs) {
  if (!wcs.refraction) return;
  const ShiftTable table = shift_table(wcs, counts.columns, counts.rows);
  for (int axis = 1; axis <= 2; ++axis) {
    std::vector<std::string> cards = {
        text_card("EXTNAME", "WCSDVARR", "WCS distortion array"),
        integer_card("EXTVER", axis, axis == 1 ? "[px] along x" : "[px] along y")};
    for (const std::string k : {"1", "2"}) {
      cards.push_back(text_card("CTYPE" + k, "LINEAR", "pixel of the frame"));
      cards.push_back(integer_card("CRPIX" + k, 0, "node; the first is 0"));
      cards.push_back(number_card("CRVAL" + k, ShiftTable::first_px, "its pixel; the first is 0"));
      cards.push_back(number_card("CDELT" + k, table.cell_px, "[px]"));
    }
    put_image(file, FitsPlace::extension, axis == 1 ? table.x_px : table.y_px, table.columns,
              cards);
  }
}

void put_plain(const ByteSink& file, const CountImage& counts, std::span<const std::string> cards,
               const FrameHeader& header, const FlagImage* flags) {
  put_image(file, FitsPlace::primary, counts.pixels, counts.columns, cards);
  if (flags)
    put_image(file, FitsPlace::extension, flags->pixels, flags->columns, flag_cards(header));
  put_shift_tables(file, counts, header.wcs);
}

}  // namespace

std::vector<std::string> frame_file_cards(const CountImage& counts, const FrameHeader& header) {
  return count_image_cards(counts.columns, counts.rows, frame_cards(counts, header, nullptr));
}

std::string encode_frame(const CountImage& counts, const FrameHeader& header,
                         const FlagImage* flags) {
  std::string file;
  put_plain([&](std::string_view piece) { file += piece; }, counts,
            frame_cards(counts, header, flags), header, flags);
  return file;
}

Frame decode_frame(std::string_view bytes, const std::string& name) {
  if (bytes.size() < fits_block_bytes || !bytes.starts_with("SIMPLE  ="))
    throw ConfigError(name + ": SIMPLE: not a FITS file");
  const HarmlessFits harmless(bytes, name);
  bytes = harmless.bytes();
  Fits fits;
  void* memory = const_cast<char*>(bytes.data());  // opened read-only
  std::size_t memory_size = bytes.size();
  fits_open_memfile(&fits.file, "frame", READONLY, &memory, &memory_size, 0, nullptr, &fits.status);
  if (fits.status != 0) throw ConfigError(name + ": not a FITS file: " + fits.reason());
  const auto shape = image_shape(fits, bytes.size(), name);
  LONGLONG end = 0;
  fits_get_hduaddrll(fits.file, nullptr, nullptr, &end, &fits.status);
  if (fits.status != 0) throw ConfigError(name + ": not a FITS file: " + fits.reason());
  require_bytes(bytes, std::size_t(end), name);
  FitsValues values;
  add_cards(fits, values);
  if (fits.status != 0) throw ConfigError(name + ": header can't be read: " + fits.reason());
  Frame frame;
  frame.notes.assumed = harmless.notes();
  frame.header = header_from_values(values, name);
  require_unsigned_counts(values, name);
  frame.counts = CountImage(int(shape[0]), int(shape[1]));
  if (values.contains("ZIMAGE")) {
    read_rice(fits, values, name, frame.counts);
    return frame;
  }
  int any_null = 0;
  fits_read_img(fits.file, TUSHORT, 1, LONGLONG(frame.counts.pixels.size()), nullptr,
                frame.counts.pixels.data(), &any_null, &fits.status);
  if (fits.status != 0) throw ConfigError(name + ": pixels can't be read: " + fits.reason());
  return frame;
}

void write_frame(const std::string& path, const CountImage& counts, const FrameHeader& header,
                 FitsCompression compression, const FlagImage* flags) {
  std::vector<std::string> cards;
  try {
    cards = frame_cards(counts, header, flags);
    if (compression == FitsCompression::rice) {
      TiledFile file(WholeFile::partial_of(path));
      file.add(counts.pixels, counts.columns, cards);
      if (flags) file.add(flags->pixels, flags->columns, flag_cards(header));
      file.close();
    }
  } catch (const Error& error) {
    throw Error(path + ": " + error.what());
  }
  const bool rice = compression == FitsCompression::rice;
  WholeFile file = rice ? WholeFile::begun(path) : WholeFile(path);
  const ByteSink sink = [&](std::string_view piece) { file.append(piece); };
  if (rice)
    put_shift_tables(sink, counts, header.wcs);
  else
    put_plain(sink, counts, cards, header, flags);
  file.finish();
}

Frame read_frame(const std::string& path) { return decode_frame(read_fits_file(path), path); }

}  // namespace dmise
