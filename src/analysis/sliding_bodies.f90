!> Bodies that slide away at the end of a run: no support holds them, and friction, which did, bears no more.
!>
!> A block on a table that tilts has an equilibrium until the tangent of the tilt is the friction coefficient (C.A. Coulomb, 1785),
!> and none beyond, in steps of any length. It is told by the state before the step that failed: what touches the body has its faces
!> along one line, with all friction the same way along it, and friction bears nearly all it can; that is what it bears of the
!> pressure where points slip, there or in the last attempt. A part that dies upset slips both ways, one in a fillet touches along
!> several lines: these do not slide away.
module sliding_bodies
  use contact_state, only: at_pressure, at_status, at_tau
  use dies, only: is_deformable
  use fields, only: displacement_field
  use kinds, only: wp
  use law_api, only: contact_open, contact_slip
  use plane_vectors, only: cross
  use scene, only: axisymmetric, is_solid, role_contact, scene_t
  use solution, only: present_coordinates, solution_t
  use text, only: to_text
  use vectors, only: length_of
  implicit none
  private
  public :: sliding_words

  !> Faces are along one line where the sine of the angle between them is no more than this.
  real(wp), parameter :: along = 0.05_wp
  !> Friction bears nearly all it can, and nearly all of it acts one way: shares.
  real(wp), parameter :: nearly = 0.9_wp

contains

  !> The first body that slides away, and what holds it; empty where none does.
  function sliding_words(scene, loose, solution) result(words)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: loose(:)   !! (nnode) the body of every node that supports do not hold, 0 for others; or of no size
    type(solution_t), intent(in) :: solution
    character(len=:), allocatable :: words
    real(wp) :: line(2), x(2, size(scene%mesh%coordinates, 2))
    character(len=:), allocatable :: name
    integer :: b, g

    words = ''
    if (size(loose) == 0 .or. scene%plane_state == axisymmetric .or. .not. solution%last_step > 0) return
    x = present_coordinates(scene, solution)
    do b = 1, maxval(loose)
      if (.not. any(loose == b)) cycle
      if (.not. slides(scene, loose, b, solution, x, line)) cycle
      name = ''
      do g = size(scene%groups), 1, -1
        if (.not. is_solid(scene%groups(g))) cycle
        if (loose(scene%groups(g)%connectivity(1, 1)) == b) name = scene%groups(g)%name
      end do
      words = name//' slides away: friction bears no more at all that touches it, and nothing else holds it along (' &
              //to_text(line(1), 3)//', '//to_text(line(2), 3)//'), so that no equilibrium is left from time ' &
              //to_text(solution%time, 6)//' on; a support, a SPRNG card, more friction or a die across that way holds it'
      return
    end do
  end function sliding_words

  !> All contact of a body is along one line, its friction acts one way, and bears nearly all it can.
  function slides(scene, loose, body, solution, x, line) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: loose(:), body   !! (nnode) bodies of the nodes; the number of one
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: x(:, :)         !! (2, nnode) at the start of the step [length]
    real(wp), intent(out) :: line(2)        !! unit vector along the faces [-]
    logical :: yes
    real(wp) :: side(2), weight, net, total, pressed, largest
    integer :: g, e, p, sign_of

    line = 0
    net = 0
    total = 0
    pressed = 0
    largest = 0
    yes = .false.
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (group%role /= role_contact .or. group%material == 0) cycle
        sign_of = 0
        if (loose(group%connectivity(1, 1)) == body) sign_of = 1
        if (is_deformable(scene%dies(group%die))) then
          if (loose(scene%dies(group%die)%nodes(1, 1)) == body) sign_of = sign_of - 1
        end if
        if (sign_of == 0) cycle
        do e = 1, size(group%connectivity, 2)
          side = x(:, group%connectivity(3, e)) - x(:, group%connectivity(1, e))
          weight = length_of(side)
          side = side/weight
          do p = 1, size(solution%groups(g)%trial, 2)
            associate (state => solution%groups(g)%committed(:, p, e))
              largest = max(largest, borne_in_slip(state), borne_in_slip(solution%groups(g)%trial(:, p, e)))
              if (nint(state(at_status)) == contact_open .or. .not. state(at_pressure) > 0) cycle
              if (.not. any(abs(line) > 0)) line = side
              if (abs(cross(line, side)) > along) return
              net = net + sign_of*weight*state(at_tau)*sign(1.0_wp, dot_product(side, line))
              total = total + weight*abs(state(at_tau))
              pressed = pressed + weight*state(at_pressure)
            end associate
          end do
        end do
      end associate
    end do
    yes = total > 0 .and. largest > 0 .and. abs(net) > nearly*total .and. total > nearly*largest*pressed
  end function slides

  !> Friction of a point that slips, over its pressure; 0 for one that does not.
  pure function borne_in_slip(state) result(share)
    real(wp), intent(in) :: state(:)   !! (nstate) [unit of each component]
    real(wp) :: share

    share = 0
    if (nint(state(at_status)) == contact_slip .and. state(at_pressure) > 0) share = abs(state(at_tau))/state(at_pressure)
  end function borne_in_slip

end module sliding_bodies
