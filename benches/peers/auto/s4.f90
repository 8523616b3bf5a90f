! S4, grown edges between clamps half a turn apart: lengths in L, moments in eta^3 Y h a^2, forces in that over L.
! par: distance z of the clamps, N, C.
module clamped
  implicit none
  private
  public :: grown
  double precision, parameter, public :: eta = 0.1d0, length = 10, growth = 2   ! xi/eta^2
  double precision, save :: last(4) = 0    ! strains of the point before, where Newton's method begins

contains

  subroutine grown(wrench, strain, compliance)
    use edge_law, only: inverse
    double precision, intent(in) :: wrench(4)
    double precision, intent(out) :: strain(4), compliance(4, 4)
    ! In the units of edge_law, and back to those above.
    double precision, parameter :: load(4) = [eta/length, eta, 1d0, 1d0]
    double precision, parameter :: unit(4) = [eta**2, eta**2*length, eta*length, eta*length]
    integer :: i
    call inverse(load*wrench, growth, last, compliance)
    strain = unit*last
    do i = 1, 4
      compliance(:, i) = unit*compliance(:, i)*load(i)
    end do
  end subroutine
end module

subroutine func(ndim, u, icp, par, ijac, f, dfdu, dfdp)
  use rod, only: field
  use clamped, only: grown
  implicit none
  integer, intent(in) :: ndim, ijac, icp(*)
  double precision, intent(in) :: u(ndim), par(*)
  double precision, intent(out) :: f(ndim)
  double precision, intent(inout) :: dfdu(ndim, ndim), dfdp(ndim, *)
  call field(u, par(2:4), par(5:7), grown, ijac /= 0, f, dfdu, dfdp(:, 2:7))
  if (ijac /= 0) dfdp(:, 1) = 0
end subroutine

! Straight and twisted, 0.2 % longer than ungrown: eps = 0.002, K3 L = pi.
subroutine stpnt(ndim, u, par, t)
  use edge_law, only: section
  use clamped, only: eta, length, growth
  implicit none
  integer, intent(in) :: ndim
  double precision, intent(inout) :: u(ndim), par(*)
  double precision, intent(in) :: t
  double precision, parameter :: pi = 4*atan(1d0)
  double precision :: wrench(4), h(4, 4), hx(4)
  call section([0.002d0/eta**2, 0d0, 0d0, pi/(eta*length)], growth, wrench, h, hx)
  par(1:7) = [1.002d0, 0d0, 0d0, wrench(1)*length/eta, 0d0, 0d0, wrench(4)]
  u = [0d0, 0d0, 1.002d0*t, cos(pi*t/2), 0d0, 0d0, sin(pi*t/2)]
end subroutine

subroutine bcnd(ndim, par, icp, nbc, u0, u1, fb, ijac, dbc)
  implicit none
  integer, intent(in) :: ndim, icp(*), nbc, ijac
  double precision, intent(in) :: par(*), u0(ndim), u1(ndim)
  double precision, intent(out) :: fb(nbc)
  double precision, intent(inout) :: dbc(nbc, *)
  integer :: i
  fb(1:7) = u0 - [0, 0, 0, 1, 0, 0, 0]
  fb(8:10) = u1(1:3) - [0d0, 0d0, par(1)]
  fb(11:13) = u1(4:6)               ! q = (0, 0, 0, 1), whose norm is known
  if (ijac == 0) return
  dbc(:, 1:2*ndim + 7) = 0
  do i = 1, 7
    dbc(i, i) = 1
  end do
  do i = 1, 6
    dbc(7 + i, ndim + i) = 1
  end do
  dbc(10, 2*ndim + 1) = -1
end subroutine

subroutine pvls(ndim, u, par)
  use record, only: write_point
  implicit none
  integer, intent(in) :: ndim
  double precision, intent(in) :: u(ndim, 0:*), par(*)
  call write_point(ndim, u, par, 7)
end subroutine

subroutine icnd
end subroutine

subroutine fopt
end subroutine
