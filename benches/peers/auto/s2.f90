! S2, cantilever strip on edge under a dead end load: lengths in L, forces in (EI2 GJ)^(1/2)/L^2.
! par: load p, C1, C3 (C2 is zero). Without growth the section is linear.
subroutine strip(wrench, strain, compliance)
  implicit none
  double precision, intent(in) :: wrench(4)
  double precision, intent(out) :: strain(4), compliance(4, 4)
  double precision, parameter :: eta = 0.1d0, length = 10, ei2 = eta**2/12, gj = eta**2/9, ei1 = 1/12d0, ea = 1
  double precision, parameter :: unit = sqrt(ei2*gj)
  double precision, parameter :: soft(4) = [unit/length**2/ea, unit/ei1, unit/ei2, unit/gj]
  integer :: i
  strain = soft*wrench
  compliance = 0
  do i = 1, 4
    compliance(i, i) = soft(i)
  end do
end subroutine

subroutine func(ndim, u, icp, par, ijac, f, dfdu, dfdp)
  use rod, only: field, law
  implicit none
  integer, intent(in) :: ndim, ijac, icp(*)
  double precision, intent(in) :: u(ndim), par(*)
  double precision, intent(out) :: f(ndim)
  double precision, intent(inout) :: dfdu(ndim, ndim), dfdp(ndim, *)
  double precision :: dw(7, 6)
  procedure(law) :: strip
  call field(u, [0d0, -par(1), 0d0], [par(2), 0d0, par(3)], strip, ijac /= 0, f, dfdu, dw)
  if (ijac == 0) return
  dfdp(:, 1) = -dw(:, 2)
  dfdp(:, 2) = dw(:, 4)
  dfdp(:, 3) = dw(:, 6)
end subroutine

subroutine stpnt(ndim, u, par, t)
  implicit none
  integer, intent(in) :: ndim
  double precision, intent(inout) :: u(ndim), par(*)
  double precision, intent(in) :: t
  par(1:3) = 0
  u = [0d0, 0d0, t, 1d0, 0d0, 0d0, 0d0]
end subroutine

subroutine bcnd(ndim, par, icp, nbc, u0, u1, fb, ijac, dbc)
  implicit none
  integer, intent(in) :: ndim, icp(*), nbc, ijac
  double precision, intent(in) :: par(*), u0(ndim), u1(ndim)
  double precision, intent(out) :: fb(nbc)
  double precision, intent(inout) :: dbc(nbc, *)
  integer :: i
  fb(1:7) = u0 - [0, 0, 0, 1, 0, 0, 0]
  fb(8) = par(2) - par(1)*u1(3)     ! M = 0, so C = r x N
  fb(9) = par(3) + par(1)*u1(1)
  if (ijac == 0) return
  dbc(:, 1:2*ndim + 3) = 0
  do i = 1, 7
    dbc(i, i) = 1
  end do
  dbc(8, ndim + 3) = -par(1); dbc(8, 2*ndim + 1) = -u1(3); dbc(8, 2*ndim + 2) = 1
  dbc(9, ndim + 1) = par(1); dbc(9, 2*ndim + 1) = u1(1); dbc(9, 2*ndim + 3) = 1
end subroutine

subroutine pvls(ndim, u, par)
  use record, only: write_point
  implicit none
  integer, intent(in) :: ndim
  double precision, intent(in) :: u(ndim, 0:*), par(*)
  call write_point(ndim, u, par, 3)
end subroutine

subroutine icnd
end subroutine

subroutine fopt
end subroutine
