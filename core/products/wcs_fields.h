#pragma once
#include "core/base/units.h"
#include "core/products/product_fields.h"
#include "core/wcs/wcs.h"

namespace dmise {

// A projection is its index and coefficients in messages; in JSON its code in FITS, or the name of
// the lens, and the coefficients by their names beside it.

template <class V, MaybeConst<WcsRefraction> R>
void visit_fields(V& v, R& air) {
  v("zenith", air.zenith);
  v("focal_length_px", air.focal_length_px);
  v.lens("lens", air.lens);
  v("pressure_hpa", air.pressure_hpa);
  v("temperature_c", air.temperature_c);
  v("humidity", air.humidity);
  v("wavelength_um", air.wavelength_um);
  v.pair("offset_x_px", air.offset_x_px, "offset_y_px", air.offset_y_px, "offset_px");
  v("cell_px", air.cell_px);
}

template <class V, MaybeConst<Wcs> W>
void visit_fields(V& v, W& w) {
  const bool distorted = w.order > 0;
  v.fits_plane("projection", w.projection, distorted);
  v.pair("crpix_x_px", w.crpix_x, "crpix_y_px", w.crpix_y, "crpix_px");
  v.pair("ra_rad", w.ra_rad, "dec_rad", w.dec_rad, "crval_deg", deg);
  v("cd_deg", w.cd_deg, "cd_deg_per_px");
  v("order", w.order);
  v.absent_unless(distorted, "a", w.a);
  v.absent_unless(distorted, "b", w.b);
  v.absent_unless(distorted, "ap", w.ap);
  v.absent_unless(distorted, "bp", w.bp);
  v("refraction", w.refraction);
  v("rms_px", w.rms_px);
  v("max_px", w.max_px);
}

}  // namespace dmise
