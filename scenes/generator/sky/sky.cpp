#include "scenes/generator/sky/sky.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scenes/generator/parallel.hpp"

namespace heliograph::scenes {
namespace {

using glm::dvec3;

// Earth's atmosphere at 680, 550 and 440 nm (Bruneton 2017; Hillaire 2020, table 1). Metres.
constexpr double ground_radius = 6360e3;
constexpr double top_altitude = 100e3;
constexpr double viewer_altitude = 300.0;  // high enough for a soft, hazy horizon
const dvec3 rayleigh_scattering{5.802e-6, 13.558e-6, 33.1e-6};
constexpr double rayleigh_height = 8000.0;
// Haze of a summer day (vertical optical depth 0.13), where the references have very clean air.
constexpr double mie_scattering = 1.0e-4;
constexpr double mie_absorption = 8.0e-6;
constexpr double mie_height = 1200.0;
constexpr double mie_asymmetry = 0.76;
const dvec3 ozone_absorption{0.650e-6, 1.881e-6, 0.085e-6};
const dvec3 solar_irradiance{1.474, 1.8504, 1.91198};
const dvec3 ground_albedo{0.24, 0.20, 0.155};  // dry earth and stone

// The sun's light on the ground, direct and from the sky, is balanced to this white; and its
// luminance to this level, so that sunlit white stone comes out near 1 after division by pi.
const dvec3 daylight_white{1.03, 1.0, 0.955};
constexpr double daylight_illuminance = 9.0;

struct Medium {
  dvec3 rayleigh;
  double mie;
  dvec3 extinction;
  dvec3 scattering() const { return rayleigh + mie; }
};

Medium medium_at(double altitude) {
  const double air = std::exp(-altitude / rayleigh_height);
  const double haze = std::exp(-altitude / mie_height);
  const double ozone = std::max(0.0, 1.0 - std::abs(altitude - 25e3) / 15e3);
  Medium medium{rayleigh_scattering * air, mie_scattering * haze, {}};
  medium.extinction =
      medium.rayleigh + (mie_scattering + mie_absorption) * haze + ozone_absorption * ozone;
  return medium;
}

double rayleigh_phase(double cosine) {
  return 3.0 / (16.0 * glm::pi<double>()) * (1.0 + cosine * cosine);
}

// Cornette and Shanks 1992.
double mie_phase(double cosine) {
  constexpr double g = mie_asymmetry;
  const double base = 1.0 + g * g - 2.0 * g * cosine;
  return 3.0 / (8.0 * glm::pi<double>()) * (1.0 - g * g) * (1.0 + cosine * cosine) /
         ((2.0 + g * g) * base * std::sqrt(base));
}

dvec3 exp_each(dvec3 v) {
  return {std::exp(v.x), std::exp(v.y), std::exp(v.z)};
}

// A ray seen in the plane through the centre of the earth: altitude along it, and where it ends.
struct Ray {
  double radius;
  double cosine;  // of the angle to the zenith at the start

  double altitude(double distance) const {
    return std::sqrt(radius * radius + distance * distance + 2.0 * radius * cosine * distance) -
           ground_radius;
  }
  // Nearest positive distance to a sphere about the centre of the earth, or -1.
  double distance_to(double sphere) const {
    const double half = radius * cosine;
    const double discriminant = half * half - radius * radius + sphere * sphere;
    if (discriminant < 0.0) return -1.0;
    const double root = std::sqrt(discriminant);
    if (-half - root > 0.0) return -half - root;
    return -half + root > 0.0 ? -half + root : -1.0;
  }
};

// Functions of the altitude under one sun. The sun's zenith angle is taken as that at the viewer:
// along the few hundred kilometres that matter it changes by less than two degrees.
class LightByAltitude {
 public:
  explicit LightByAltitude(double sun_cosine) {
    for (std::size_t i = 0; i < entries; ++i) sun_[i] = sunlight(altitude_of(i), sun_cosine);
    for (std::size_t i = 0; i < entries; ++i) multiple_[i] = multiple_scattering(altitude_of(i));
  }

  dvec3 sun(double altitude) const { return look_up(sun_, altitude); }
  /// In-scattered radiance of second and higher orders per unit of scattering coefficient.
  dvec3 multiple(double altitude) const { return look_up(multiple_, altitude); }

 private:
  static constexpr std::size_t entries = 128;
  using Table = std::array<dvec3, entries>;

  // Denser near the ground, where the haze is.
  static double altitude_of(std::size_t i) {
    const double t = double(i) / double(entries - 1);
    return top_altitude * t * t * t;
  }
  static dvec3 look_up(const Table& table, double altitude) {
    const double t = std::cbrt(std::clamp(altitude / top_altitude, 0.0, 1.0));
    const double position = t * double(entries - 1);
    const auto low = std::min(std::size_t(position), entries - 2);
    return glm::mix(table[low], table[low + 1], position - double(low));
  }

  static dvec3 sunlight(double altitude, double sun_cosine);
  dvec3 multiple_scattering(double altitude) const;

  Table sun_{};
  Table multiple_{};
};

dvec3 LightByAltitude::sunlight(double altitude, double sun_cosine) {
  const Ray ray{ground_radius + altitude, sun_cosine};
  const double length = std::max(0.0, ray.distance_to(ground_radius + top_altitude));
  constexpr int steps = 80;
  dvec3 depth(0.0);
  for (int i = 0; i < steps; ++i) {
    depth += medium_at(ray.altitude((i + 0.5) / steps * length)).extinction * (length / steps);
  }
  return solar_irradiance * exp_each(-depth);
}

// Second order light and the share that each further order passes on, both over the sphere of
// directions with an isotropic phase function; the orders then form a geometric series.
dvec3 LightByAltitude::multiple_scattering(double altitude) const {
  constexpr int directions = 48;
  constexpr int steps = 32;
  dvec3 second_order(0.0);
  dvec3 passed_on(0.0);
  for (int k = 0; k < directions; ++k) {
    const Ray ray{ground_radius + std::max(altitude, 1.0), 1.0 - 2.0 * (k + 0.5) / directions};
    const double ground = ray.distance_to(ground_radius);
    const double length =
        ground > 0.0 ? ground : std::max(0.0, ray.distance_to(ground_radius + top_altitude));
    dvec3 transmittance(1.0);
    for (int i = 0; i < steps; ++i) {
      const double step = length / steps;
      const double height = std::max(0.0, ray.altitude((i + 0.5) * step));
      const Medium medium = medium_at(height);
      const dvec3 through = exp_each(-medium.extinction * step);
      const dvec3 collected =
          transmittance * medium.scattering() * (1.0 - through) / medium.extinction;
      second_order += collected * sun(height) / (4.0 * glm::pi<double>()) / double(directions);
      passed_on += collected / double(directions);
      transmittance *= through;
    }
    if (ground > 0.0) {
      second_order +=
          transmittance * ground_albedo / glm::pi<double>() * sun(0.0) / double(directions);
    }
  }
  return second_order / (1.0 - passed_on);
}

dvec3 radiance_along(const LightByAltitude& light, dvec3 direction, dvec3 to_sun,
                     dvec3 ground_radiance) {
  const Ray ray{ground_radius + viewer_altitude, direction.y};
  const double ground = ray.distance_to(ground_radius);
  const double length = ground > 0.0 ? ground : ray.distance_to(ground_radius + top_altitude);
  const double cosine = glm::dot(direction, to_sun);
  const double rayleigh = rayleigh_phase(cosine);
  const double mie = mie_phase(cosine);
  constexpr int steps = 40;
  dvec3 transmittance(1.0);
  dvec3 radiance(0.0);
  double start = 0.0;
  for (int i = 0; i < steps; ++i) {
    // Steps grow with the distance: the dense air is near.
    const double t = double(i + 1) / steps;
    const double end = length * t * t;
    const double altitude = std::max(0.0, ray.altitude(0.5 * (start + end)));
    const Medium medium = medium_at(altitude);
    const dvec3 through = exp_each(-medium.extinction * (end - start));
    const dvec3 scattered = (medium.rayleigh * rayleigh + medium.mie * mie) * light.sun(altitude) +
                            medium.scattering() * light.multiple(altitude);
    radiance += transmittance * scattered * (1.0 - through) / medium.extinction;
    transmittance *= through;
    start = end;
  }
  if (ground > 0.0) radiance += transmittance * ground_radiance;
  return radiance;
}

double luminance(dvec3 c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

}  // namespace

ClearSky make_clear_sky(glm::vec3 to_sun, int width, int height) {
  const dvec3 sun_direction(to_sun);
  const LightByAltitude light(sun_direction.y);
  ClearSky sky{Environment(width, height), {}, {}};
  const auto fill = [&](int first_row, int last_row, dvec3 ground_radiance) {
    parallel_for(std::size_t(last_row - first_row), [&](std::size_t row) {
      const int y = first_row + int(row);
      for (int x = 0; x < width; ++x) {
        const dvec3 direction(sky.environment.direction(x, y));
        sky.environment.at(x, y) =
            glm::vec3(radiance_along(light, direction, sun_direction, ground_radiance));
      }
    });
  };
  fill(0, height / 2, dvec3(0.0));
  const dvec3 from_sky(sky.environment.horizontal_irradiance());
  const dvec3 from_sun = light.sun(0.0) * sun_direction.y;
  fill(height / 2, height, ground_albedo / glm::pi<double>() * (from_sun + from_sky));

  const dvec3 daylight = from_sun + from_sky;
  const dvec3 balance =
      daylight_white / luminance(daylight_white) * daylight_illuminance / daylight;
  for (glm::vec3& pixel : sky.environment.radiance) pixel *= glm::vec3(balance);
  sky.sun_irradiance = glm::vec3(light.sun(0.0) * balance);
  sky.sky_irradiance = glm::vec3(from_sky * balance);
  return sky;
}

}  // namespace heliograph::scenes
