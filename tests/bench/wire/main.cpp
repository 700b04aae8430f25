#include <algorithm>
#include <cmath>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "proto/frames/mesh.h"
#include "proto/frames/packed_frame.h"
#include "tests/bench/wire/recording.h"

// What a frame costs on the wire: bytes a vertex and CPU time, of the codec `packed` and of simpler
// ones on the same frames. Leaves the packed streams for wire.mjs, which decodes them in JavaScript
// and compares them with a general compressor.

namespace {

using namespace weft;
using namespace weft::bench;
using namespace weft::proto;
using namespace weft::proto::codec;

double cpu_milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double largest_error(const std::vector<float>& a, const std::vector<float>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); i += 3) {
    double square = 0;
    for (std::size_t c = 0; c < 3; ++c)
      square += std::pow(static_cast<double>(a[i + c]) - static_cast<double>(b[i + c]), 2);
    largest = std::max(largest, square);
  }
  return std::sqrt(largest);
}

struct Int16 {
  double bytes = 0, error = 0;  ///< a vertex; largest [m]
};

/// Positions as 16-bit integers in their box, which comes with them.
Int16 as_int16(const std::vector<float>& positions) {
  const Bounds bounds = bounds_of(positions);
  std::vector<std::uint16_t> packed(positions.size());
  std::vector<float> shown(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double low = static_cast<double>(bounds.low[i % 3]);
    const double step = (static_cast<double>(bounds.high[i % 3]) - low) / 65535;
    if (step > 0)
      packed[i] =
          static_cast<std::uint16_t>(std::lround((static_cast<double>(positions[i]) - low) / step));
    shown[i] = static_cast<float>(low + step * packed[i]);
  }
  const std::size_t bytes = packed.size() * sizeof packed[0] + sizeof bounds;
  return {static_cast<double>(3 * bytes) / static_cast<double>(positions.size()),
          largest_error(positions, shown)};
}

/// Packs a recording as a server does for viewers that miss no frame, and decodes it.
nlohmann::json pack(const Recording& recording, double error, std::ofstream& stream) {
  const std::uint32_t count = recording.cloth.vertices;
  const CodingOrder order =
      make_order(recording.frames.front(), recording.triangles, {&recording.cloth, 1});
  SceneMesh mesh{recording.frames.front(),
                 recording.triangles,
                 std::vector<float>(2 * std::size_t{count}),
                 {},
                 {}};
  if (!order.natural) mesh.order = order_words(order);
  const auto write = [&stream](const Bytes& bytes) {
    stream.write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
  };
  write(encode_mesh_data(mesh));
  PayloadEncoder encoder;
  FrameDecoder decoder;
  decoder.begin(order);
  std::optional<Lattice> lattice;
  std::array<Integers, 3> held;
  std::vector<double> encode_times, decode_times, sizes;
  double worst = 0;
  Int16 int16;
  Bytes plain;
  std::uint32_t since_key = 0;
  for (std::uint32_t n = 0; n < recording.frames.size(); ++n) {
    const std::vector<float>& positions = recording.frames[n];
    const double start = cpu_milliseconds();
    const Bounds bounds = bounds_of(positions);
    const bool key = !lattice || !holds(*lattice, bounds);
    if (key) lattice = make_lattice(bounds, error, 0);
    since_key = key ? 0 : since_key + 1;
    PackRequest request;
    if (since_key > 0) request.references.last = &held[(n + 2) % 3];
    if (since_key > 1) request.references.before = &held[(n + 1) % 3];
    request.before = n - 2;
    quantise(*lattice, positions, order.vertices, held[n % 3]);
    const Bytes payload = encoder.encode(order, *lattice, held[n % 3], request);
    encode_times.push_back(cpu_milliseconds() - start);
    FrameHeader header;
    header.sequence = header.reference = n;
    header.tick = n;
    encode_frame({header, positions, {}, {}, {}, {}, {}}, plain);
    const Bytes packed = pack_frame(plain, {key ? n : n - 1, lattice->step}, payload);
    const double middle = cpu_milliseconds();
    const Result<Frame> frame = decoder.decode(packed);
    decode_times.push_back(cpu_milliseconds() - middle);
    if (!frame) throw std::runtime_error(frame.error().message);
    worst = std::max(worst, largest_error(positions, frame->positions));
    const Int16 simple = as_int16(positions);
    int16 = {simple.bytes, std::max(int16.error, simple.error)};
    if (!key) sizes.push_back(static_cast<double>(packed.size()) / count);
    write(packed);
  }
  double bytes = 0;
  for (const double size : sizes) bytes += size / static_cast<double>(sizes.size());
  std::sort(sizes.begin(), sizes.end());
  return {{"motion", recording.motion},
          {"mesh", recording.mesh},
          {"mean_speed", recording.mean_speed},
          {"frames", recording.frames.size()},
          {"vertices", count},
          {"rows", recording.cloth.rows},
          {"columns", recording.cloth.columns},
          {"error_bound", error},
          {"largest_error", worst},
          {"float32_bytes", static_cast<double>(plain.size()) / count},
          {"int16_bytes", int16.bytes},
          {"int16_largest_error", int16.error},
          {"packed_bytes", bytes},
          {"packed_bytes_p95", sizes[sizes.size() * 95 / 100]},
          {"encode_ms", median(encode_times)},
          {"decode_ms", median(decode_times)}};
}

void measure(const std::string& out, int side, int frames) {
  std::filesystem::create_directories(out);
  nlohmann::json table = nlohmann::json::array();
  for (const char* motion : {"gusts", "calm"}) {
    std::cerr << "wire: " << motion << std::endl;
    const Recording grid = record_motion(motion, side, frames);
    std::cerr << "wire: mean speed " << grid.mean_speed << " m/s" << std::endl;
    for (const Recording& recording :
         {grid, as_mesh(grid), record_random_mesh(motion, side, frames)})
      for (const double error : {1e-4, 1e-5}) {
        const std::string name = recording.motion + "-" + recording.mesh + "-" +
                                 (error > 5e-5 ? "0.1" : "0.01") + "mm.bin";
        std::ofstream stream(std::filesystem::path(out) / name, std::ios::binary);
        nlohmann::json row = pack(recording, error, stream);
        row["stream"] = name;
        if (!stream.flush()) throw std::runtime_error("cannot write " + name);
        table.push_back(std::move(row));
      }
  }
  std::ofstream file(std::filesystem::path(out) / "wire.json");
  file << table.dump(1) << "\n";
  if (!file.flush()) throw std::runtime_error("cannot write wire.json");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Measures what frames cost on the wire.");
  std::string out;
  int side = 128, frames = 600;
  app.add_option("--out", out, "folder for the streams and wire.json")->required();
  app.add_option("--side", side, "particles a side")->check(CLI::Range(2, 512));
  app.add_option("--frames", frames, "at 60 a second")->check(CLI::Range(10, 10000));
  CLI11_PARSE(app, argc, argv);
  try {
    measure(out, side, frames);
  } catch (const std::exception& error) {
    std::cerr << "weft_wire_bench: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
