!> What acts in a scene: motions and loads that the deck gives, temperatures, and whether bodies answer to these.
module acting_causes
  use contact_outlook, only: moves
  use dies, only: is_deformable
  use fields, only: displacement_field
  use law_api, only: law_t, solid_law
  use scene, only: scene_t
  use supports, only: is_mechanical_load
  implicit none
  private
  public :: anything_acts, expands, is_warm, unloaded

  !> Laws for solids in which temperatures make no strain.
  character(len=6), parameter :: without_expansion(*) = [character(len=6) :: 'ELA', 'EPLA', 'EVP-NH', 'GSELL']

contains

  !> Temperatures change, and a body answers to them with a strain.
  pure function expands(scene, laws) result(yes)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    logical :: yes
    integer :: k

    yes = .false.
    if (.not. is_warm(scene)) return
    do k = 1, size(scene%groups)
      associate (group => scene%groups(k))
        if (group%material == 0 .or. group%die > 0) cycle
        associate (law => laws(scene%materials(group%material)%law_id))
          if (law%kind == solid_law) yes = yes .or. .not. any(without_expansion == law%name)
        end associate
      end associate
    end do
  end function expands

  !> Temperatures act on bodies: a field, or given ones.
  pure function is_warm(scene) result(yes)
    type(scene_t), intent(in) :: scene
    logical :: yes
    integer :: k

    yes = has_temperature(scene)
    do k = 1, size(scene%groups)
      yes = yes .or. max(scene%groups(k)%temperature_multiplier, scene%groups(k)%temperature_history) > 0
    end do
  end function is_warm

  !> A field beside the motion.
  pure function has_temperature(scene) result(yes)
    type(scene_t), intent(in) :: scene
    logical :: yes
    integer :: k

    yes = any([(scene%fields(k)%declared .and. scene%fields(k)%quantity /= 'motion', k=1, size(scene%fields))])
  end function has_temperature

  !> Nothing but this die moves by what the deck gives, and no load acts; heat that passes is none.
  pure function unloaded(scene, die) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: die   !! 0 for none
    logical :: yes
    integer :: k

    yes = size(scene%die_forces) == 0 .and. size(scene%forces) == 0 &
          .and. all(scene%section_drives%multiplier == 0) .and. scene%load_factor%multiplier == 0
    do k = 1, size(scene%groups)
      yes = yes .and. .not. is_mechanical_load(scene%groups(k))
    end do
    do k = 1, size(scene%dies)
      if (k /= die) yes = yes .and. .not. moves(scene, k)
    end do
    do k = 1, size(scene%fixations)
      yes = yes .and. (scene%fixations(k)%multiplier == 0 .or. scene%fixations(k)%field /= displacement_field)
    end do
  end function unloaded

  !> A multiplier is not zero at some time, or the scene needs none: heat acts by itself, bodies that begin in each other press.
  pure function anything_acts(scene) result(yes)
    type(scene_t), intent(in) :: scene
    logical :: yes
    integer :: k

    yes = is_warm(scene) .or. any([(is_deformable(scene%dies(k)), k=1, size(scene%dies))])
    do k = 1, size(scene%multipliers)
      yes = yes .or. maxval(abs(scene%multipliers(k)%value)) > 0
    end do
  end function anything_acts

end module acting_causes
