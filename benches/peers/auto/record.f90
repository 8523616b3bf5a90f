! Appends parameters and states at the middle and the end of every point to `points.txt`, with all digits: AUTO prints eleven.
module record
  implicit none
  private
  public :: write_point

contains

  subroutine write_point(ndim, u, par, npar)
    integer, intent(in) :: ndim, npar
    double precision, intent(in) :: u(ndim, 0:*), par(*)
    double precision, external :: getp
    integer :: last
    logical, save :: first = .true.
    if (first) open (77, file='points.txt', status='replace')
    first = .false.
    last = nint(getp('NTST', 0, u))*nint(getp('NCOL', 0, u))
    write (77, '(*(ES26.16E3))') par(1:npar), u(:, last/2), u(:, last)
  end subroutine
end module
