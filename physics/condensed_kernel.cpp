#include "physics/condensed.hpp"
#include "physics/instruction_sets.hpp"

namespace turnpoint::physics {
namespace {

constexpr int panel = 4;  // number of unknowns that are eliminated from the remaining columns in one pass

}  // namespace

TURNPOINT_CLONES
void eliminate_first(double* re, double* im, int size, int count) {
  for (int first = 0; first < count; first += panel) {
    const int last = first + panel < count ? first + panel : count;
    for (int j = first; j < last; ++j) {  // eliminate within the panel
      double *const aj = re + j * size, *const bj = im + j * size;
      for (int p = first; p < j; ++p) {
        const double *const ap = re + p * size, *const bp = im + p * size;
        const double dr = re[p * size + p], di = im[p * size + p];
        const double fr = ap[j] * dr - bp[j] * di, fi = ap[j] * di + bp[j] * dr;
        for (int k = j; k < size; ++k) {
          aj[k] -= ap[k] * fr - bp[k] * fi;
          bj[k] -= ap[k] * fi + bp[k] * fr;
        }
      }
      const double norm = aj[j] * aj[j] + bj[j] * bj[j];
      const double ir = aj[j] / norm, ii = -bj[j] / norm;
      for (int k = j + 1; k < size; ++k) {
        const double a = aj[k], b = bj[k];
        aj[k] = a * ir - b * ii;
        bj[k] = a * ii + b * ir;
      }
    }
    double fr[panel] = {}, fi[panel] = {};
    const double *a[panel], *b[panel];
    // the last panel may have fewer columns; treat the missing ones as zero
    for (int p = 0; p < panel; ++p) {
      const int j = first + p < last ? first + p : first;
      a[p] = re + j * size, b[p] = im + j * size;
    }
    for (int i = last; i < size; ++i) {
      for (int p = 0; p < last - first; ++p) {
        const double dr = a[p][first + p], di = b[p][first + p];
        fr[p] = a[p][i] * dr - b[p][i] * di, fi[p] = a[p][i] * di + b[p][i] * dr;
      }
      double* __restrict const ai = re + i * size;
      double* __restrict const bi = im + i * size;
      for (int k = i; k < size; ++k) {
        ai[k] -= a[0][k] * fr[0] - b[0][k] * fi[0] + (a[1][k] * fr[1] - b[1][k] * fi[1]) +
                 (a[2][k] * fr[2] - b[2][k] * fi[2]) + (a[3][k] * fr[3] - b[3][k] * fi[3]);
        bi[k] -= a[0][k] * fi[0] + b[0][k] * fr[0] + (a[1][k] * fi[1] + b[1][k] * fr[1]) +
                 (a[2][k] * fi[2] + b[2][k] * fr[2]) + (a[3][k] * fi[3] + b[3][k] * fr[3]);
      }
    }
  }
}

}  // namespace turnpoint::physics
