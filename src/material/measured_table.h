// A measured reflection, tabulated in a parametrisation that follows the highlight (Dupuy and Jakob 2018, "An Adaptive
// Parameterization for Efficient Material Acquisition and Rendering").
#pragma once
#include <optional>

#include "material/bsdf.h"
#include "mc/bilinear.h"

namespace montelux {

// How the directions wo beyond the measured sector of azimuths follow from those within. The sector begins at -pi.
enum class AzimuthSymmetry { none, half_turn, two_mirrors };

// The content of a file, as MeasuredTable needs it. Functions of wo have a table for each azimuth and, within that, for
// each elevation; the grids are over a unit square, x first. A half vector m of spherical angles theta and phi has the
// place x = sqrt(2 theta / pi), y = (phi + pi) / (2 pi); for isotropic surfaces phi is relative to that of wo.
struct MeasuredData {
  std::vector<float> elevations;  // angles of wo with the normal, increasing
  std::vector<float> azimuths;    // of wo, increasing; one for an isotropic surface
  AzimuthSymmetry symmetry = AzimuthSymmetry::none;
  GridSize ndf_size, sigma_size, vndf_size, value_size;
  std::vector<float> ndf;         // D(m), over the place of m
  std::vector<float> sigma;       // projected area of the facets along wo, over the place of wo in the same sense
  std::vector<float> vndf;        // of the density of facets visible from wo, over the place of m; up to a factor
  std::vector<float> luminance;   // of the values, up to a factor
  std::vector<float> values;      // red, green, blue of f |cos wi| / (D / (4 sigma)), or of f |cos wi|
  bool divided_by_facets = true;  // which of the two
};

class MeasuredTable {
 public:
  // The data must be consistent: sizes as stated, finite, not negative.
  explicit MeasuredTable(MeasuredData data);

  bool is_isotropic() const { return azimuths_.size() == 1; }

  // For directions above the surface. f is zero where sample() has no density.
  BsdfValue<float> evaluate(Vec3f wo, Vec3f wi) const;
  // A direction, which may be below the surface, and the value there; zero if it is below.
  struct Sample {
    Vec3f wi;
    BsdfValue<float> value;
  };
  Sample sample(Vec3f wo, Vec2f u) const;

 private:
  struct Outgoing;
  struct Half;
  Outgoing outgoing(Vec3f wo) const;
  BsdfValue<float> value_at(const Outgoing& o, const Half& half, Vec2f u) const;

  std::vector<float> elevations_, azimuths_;
  AzimuthSymmetry symmetry_;
  bool divided_by_facets_;
  BilinearTables<1> ndf_, sigma_;
  BilinearDensities vndf_, luminance_;
  BilinearTables<rgb_size> values_;
};

}  // namespace montelux
