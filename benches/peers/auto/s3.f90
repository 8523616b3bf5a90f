! S3, elastica: inextensible column under a dead end load, plane, as L = EI = 1.
! Angle theta from the axis; x across, z along: theta' = m, m' = -p sin theta. par: load p.
subroutine func(ndim, u, icp, par, ijac, f, dfdu, dfdp)
  implicit none
  integer, intent(in) :: ndim, ijac, icp(*)
  double precision, intent(in) :: u(ndim), par(*)
  double precision, intent(out) :: f(ndim)
  double precision, intent(inout) :: dfdu(ndim, ndim), dfdp(ndim, *)
  double precision :: s, c
  s = sin(u(1)); c = cos(u(1))
  f = [u(2), -par(1)*s, s, c]
  if (ijac == 0) return
  dfdu = 0
  dfdu(1, 2) = 1
  dfdu(2:4, 1) = [-par(1)*c, c, -s]
  dfdp(:, 1) = [0d0, -s, 0d0, 0d0]
end subroutine

subroutine stpnt(ndim, u, par, t)
  implicit none
  integer, intent(in) :: ndim
  double precision, intent(inout) :: u(ndim), par(*)
  double precision, intent(in) :: t
  par(1) = 0
  u = [0d0, 0d0, 0d0, t]
end subroutine

subroutine bcnd(ndim, par, icp, nbc, u0, u1, fb, ijac, dbc)
  implicit none
  integer, intent(in) :: ndim, icp(*), nbc, ijac
  double precision, intent(in) :: par(*), u0(ndim), u1(ndim)
  double precision, intent(out) :: fb(nbc)
  double precision, intent(inout) :: dbc(nbc, *)
  fb = [u0(1), u0(3), u0(4), u1(2)]
  if (ijac == 0) return
  dbc(:, 1:2*ndim + 1) = 0
  dbc(1, 1) = 1
  dbc(2, 3) = 1
  dbc(3, 4) = 1
  dbc(4, ndim + 2) = 1
end subroutine

subroutine pvls(ndim, u, par)
  use record, only: write_point
  implicit none
  integer, intent(in) :: ndim
  double precision, intent(in) :: u(ndim, 0:*), par(*)
  call write_point(ndim, u, par, 1)
end subroutine

subroutine icnd
end subroutine

subroutine fopt
end subroutine
