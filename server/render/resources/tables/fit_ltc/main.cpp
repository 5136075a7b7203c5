// Fits linearly transformed cosines to the specular lobe of shaders/lib/lighting/brdf.glsl and
// prints the table of server/render/resources/tables, or compares the committed one with the fit:
//
//   fit_ltc > server/render/resources/tables/ltc_table.inc
//   fit_ltc --check
//
// Heitz, Dupuy, Hill and Neubelt, "Real-Time Polygonal-Light Shading with Linearly Transformed
// Cosines" (2016). The result does not depend on the number of threads.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <glm/gtc/packing.hpp>
#include <string_view>
#include <thread>
#include <vector>

#include "render/resources/tables/fit_ltc/lobe.hpp"
#include "render/resources/tables/fit_ltc/nelder_mead.hpp"

namespace {

using heliograph::ltc::minimize;
using heliograph::ltc::SpecularLobe;
using heliograph::ltc::TransformedCosine;
using Shape = std::array<double, 3>;  // spread along and across the view, skew along it

constexpr int table_size = 64;
constexpr double least_roughness = 0.01;
constexpr int strata = 32;

struct Mean {
  double albedo;
  glm::dvec3 direction;
};

/// Where the lobe points on average, in the plane of the view and the normal.
Mean mean_of(const SpecularLobe& lobe) {
  Mean mean{};
  for (int i = 0; i < strata * strata; ++i) {
    const glm::dvec3 light = lobe.sample((i % strata + 0.5) / strata, (i / strata + 0.5) / strata);
    if (light.z <= 0.0) continue;
    const double weight = lobe(light) / lobe.density(light) / (strata * strata);
    mean.albedo += weight;
    mean.direction += weight * light;
  }
  mean.direction.y = 0.0;
  mean.direction = glm::normalize(mean.direction);
  return mean;
}

glm::dmat3 matrix_of(const Shape& shape, const glm::dvec3& z, bool isotropic) {
  const double along = std::max(shape[0], 1e-7);
  const double across = isotropic ? along : std::max(shape[1], 1e-7);
  const glm::dmat3 frame(glm::dvec3(z.z, 0.0, -z.x), glm::dvec3(0.0, 1.0, 0.0), z);
  return frame * glm::dmat3(glm::dvec3(along, 0.0, 0.0), glm::dvec3(0.0, across, 0.0),
                            glm::dvec3(isotropic ? 0.0 : shape[2], 0.0, 1.0));
}

/// The cube of the difference above the horizon, integrated with samples of both: a lobe that
/// misses the other's peak costs most. The fit is cut off at the horizon and made as bright again
/// as it was whole, as shaders/lib/lighting/ltc.glsl does.
double difference(const SpecularLobe& lobe, double albedo, const TransformedCosine& fit) {
  double sum = 0.0;
  const double above = fit.share_above();
  const auto add = [&](const glm::dvec3& light) {
    if (light.z <= 0.0) return;
    const double target = lobe(light) / albedo;
    const double whole = fit(light);
    const double density = whole + lobe.density(light);
    const double difference_here = std::abs(target - whole / above);
    if (density > 0.0) sum += difference_here * difference_here * difference_here / density;
  };
  for (int i = 0; i < strata * strata; ++i) {
    const double u = (i % strata + 0.5) / strata, v = (i / strata + 0.5) / strata;
    add(lobe.sample(u, v));
    add(fit.sample(u, v));
  }
  return sum;
}

/// The four numbers of the inverse matrix that are neither 0 nor, after scaling, 1.
glm::vec4 entries(const glm::dmat3& inverse) {
  const double scale = 1.0 / inverse[1][1];
  return glm::vec4(inverse[0][0] * scale, inverse[0][2] * scale, inverse[2][0] * scale,
                   inverse[2][2] * scale);
}

/// One roughness, from looking straight down to looking along the surface; each fit starts where
/// the one before ended.
std::vector<glm::vec4> fit_row(int row) {
  const double roughness = std::max(row / (table_size - 1.0), least_roughness);
  const double alpha = roughness * roughness;
  std::vector<glm::vec4> fitted;
  Shape shape{alpha, alpha, 0.0};
  for (int column = 0; column < table_size; ++column) {
    const double x = column / (table_size - 1.0);
    const double cosine = std::max(1.0 - x * x, 1e-3);  // sqrt(1 - n.v) is the coordinate
    const SpecularLobe lobe({std::sqrt(1.0 - cosine * cosine), 0.0, cosine}, alpha);
    Mean mean = mean_of(lobe);
    const bool isotropic = column == 0;
    if (isotropic) mean.direction = {0.0, 0.0, 1.0};
    const auto cost = [&](const Shape& candidate) {
      if (candidate[0] <= 0.0 || candidate[1] <= 0.0) return 1e30;
      return difference(lobe, mean.albedo,
                        TransformedCosine(matrix_of(candidate, mean.direction, isotropic)));
    };
    shape = minimize(shape, 0.1 * std::max(shape[0], shape[1]), cost);
    shape = minimize(shape, 0.02 * std::max(shape[0], shape[1]), cost);
    if (isotropic) shape = {shape[0], shape[0], 0.0};
    fitted.push_back(
        entries(TransformedCosine(matrix_of(shape, mean.direction, isotropic)).inverse()));
  }
  return fitted;
}

void print(const std::vector<std::vector<glm::vec4>>& rows) {
  std::printf("// Printed by fit_ltc; not edited by hand.\n");
  int printed = 0;
  for (const auto& row : rows) {
    for (const glm::vec4& entry : row) {
      const bool ends_line = ++printed % 5 == 0 || printed == table_size * table_size;
      std::printf("0x%llx,%s", static_cast<unsigned long long>(glm::packHalf4x16(entry)),
                  ends_line ? "\n" : " ");
    }
  }
}

constexpr std::uint64_t committed[] = {
#include "render/resources/tables/ltc_table.inc"
};

/// Whether the committed entries are those of `rows` but for rounding. Compilers round sums
/// differently, and the search for the best fit stops elsewhere.
bool check(const std::vector<std::vector<glm::vec4>>& rows) {
  constexpr float tolerance = 0.02f;
  float largest = 0.0f;
  for (std::size_t i = 0; i < std::size(committed); ++i) {
    const glm::vec4 entry = glm::unpackHalf4x16(committed[i]);
    const glm::vec4 fitted = rows[i / table_size][i % table_size];
    for (int c = 0; c < 4; ++c) {
      largest = std::max(largest, std::abs(entry[c] - fitted[c]) / (1.0f + std::abs(fitted[c])));
    }
  }
  std::printf("ltc_table.inc differs from the fit by at most %g, allowed are %g\n",
              static_cast<double>(largest), static_cast<double>(tolerance));
  return largest <= tolerance;
}

}  // namespace

int main(int count, char** arguments) {
  std::vector<std::vector<glm::vec4>> rows(table_size);
  const unsigned workers = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::jthread> threads;
  for (unsigned worker = 0; worker < workers; ++worker) {
    threads.emplace_back([&rows, worker, workers] {
      for (unsigned row = worker; row < table_size; row += workers) {
        rows[row] = fit_row(static_cast<int>(row));
      }
    });
  }
  threads.clear();
  if (count > 1 && std::string_view(arguments[1]) == "--check") return check(rows) ? 0 : 1;
  print(rows);
}
