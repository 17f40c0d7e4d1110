!> Where the work of a run came from and where it went, since the start; per radian when axisymmetric.
module work_books
  use kinds, only: wp
  implicit none
  private
  public :: work_t

  type :: work_t
    !> From outside [energy]: at nodes whose motion is given, at dies, of loads on other nodes, on the section.
    real(wp) :: supports = 0.0_wp, dies = 0.0_wp, loads = 0.0_wp, section = 0.0_wp
    !> Of temperatures: what expansion, and moduli that change, give to the elastic energy [energy].
    real(wp) :: heat = 0.0_wp
    !> Dissipated by flow [energy].
    real(wp) :: flow = 0.0_wp
    !> Kept by the penalties of contact, and taken by its multipliers [energy].
    real(wp) :: contact = 0.0_wp
    !> Taken by the viscous forces of steps that are damped [energy].
    real(wp) :: damping = 0.0_wp
    !> Taken by the drag on bodies that nothing holds and nothing loads [energy].
    real(wp) :: drag = 0.0_wp
    !> Brought in by parts that lay in a die at the start [energy].
    real(wp) :: overlap = 0.0_wp
    !> Elastic energy at the last instant, and what it was given other than by a step: by a new mesh [energy].
    real(wp) :: elastic = 0.0_wp, remeshing = 0.0_wp
    !> All that passed, by the sizes of its parts; and what round-off may amount to in it [energy].
    real(wp) :: passed = 0.0_wp, round_off = 0.0_wp
    !> Work from outside in the last step, by the sizes of what supports, loads, section and each die did [energy].
    real(wp) :: from_outside = 0.0_wp
    !> Volume that thermal expansion made [volume].
    real(wp) :: grown = 0.0_wp
  end type work_t

end module work_books
