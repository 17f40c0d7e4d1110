!> Ways to a new mesh, in the order they are tried at a stop of the old one, and whether the try at hand is there.
module cycle_ways
  use cycle_situation, only: checkpoint_file_t, is_due_by, is_first_mesh, is_read, must_be_replaced, situation_t
  use cycle_table, only: way_agreed, way_anew, way_coarser, way_deck, way_earlier, way_finer, way_mesher, way_old_mesh, &
                         way_transfer
  use cycle_tries, only: agreed_way, keeps_old_mesh, mesh_is_responsible, number_refused, took_earlier, transfer_is_responsible, &
                         was_refused
  implicit none
  private
  public :: next_way, old_state, old_mesh_goes_on, is_whole

contains

  !> The first way that was not tried yet at this stop, '' when there is none left or enough were.
  pure function next_way(s) result(way)
    type(situation_t), intent(in) :: s
    character(len=:), allocatable :: way
    character(len=*), parameter :: ways(*) = [character(len=16) :: way_anew, way_deck, way_transfer, way_finer, way_mesher, &
                                                                way_agreed, way_earlier, way_coarser, way_agreed, way_old_mesh]
    integer :: k, most

    associate (generation => s%new%generation, stop_step => s%new%old_end%facts%step)
      most = s%tries
      if (most < 0) most = s%new%old_end%facts%tries
      way = ''
      if (number_refused(s%rows, generation, stop_step) > most) return
      do k = 1, size(ways)
        way = trim(ways(k))
        if (was_refused(s%rows, generation, stop_step, way)) cycle
        if (way == way_transfer .and. .not. transfer_is_responsible(s%rows, generation, stop_step)) cycle
        if (way == way_mesher) then
          ! zones of a first mesh are the deck's to mend
          if (is_first_mesh(s%new%old_end%facts) .or. .not. s%new%old_end%facts%has_zones) cycle
          if (.not. mesh_is_responsible(s%rows, generation, stop_step)) cycle
        end if
        if (way == way_agreed .and. agreed_way(s%rows, generation, stop_step) == '') cycle
        if (way == way_earlier .and. .not. has_earlier(s)) cycle
        if (way == way_anew .and. .not. first_mesh_erred(s)) cycle
        ! once, and not where the old mesh could go no further or there is none
        if (way == way_old_mesh) then
          if (cannot_go_on(s) .or. keeps_old_mesh(s%rows, generation)) cycle
        end if
        return
      end do
    end associate
    way = ''
  end function next_way

  !> Did a first mesh, made from contours alone, stop with an error of the stress beyond its limit? It was wrong from the beginning,
  !> and there is nothing yet that is worth a transfer: the scene begins anew on a better one, once.
  pure function first_mesh_erred(s) result(erred)
    type(situation_t), intent(in) :: s
    logical :: erred

    erred = is_read(s%new%old_source) .and. s%new%old_end%facts%operation <= 1
    if (erred) erred = is_first_mesh(s%new%old_source%facts) .and. is_due_by(s%new%old_end%facts, 'stress_error') &
                       .and. .not. must_be_replaced(s%new%old_end%facts)
  end function first_mesh_erred

  !> Is there a save of the old mesh before the last one? Not a second time for the same stop: a mesh made from there may stop here
  !> too.
  pure function has_earlier(s)
    type(situation_t), intent(in) :: s
    logical :: has_earlier

    has_earlier = is_read(s%new%old_earlier)
    if (.not. has_earlier) return
    associate (earlier => s%new%old_earlier%facts, last => s%new%old_end%facts)
      has_earlier = earlier%generation == s%new%generation - 1 .and. .not. earlier%unbalanced .and. earlier%step > 0 &
                    .and. earlier%step < last%step .and. .not. took_earlier(s%rows, last%time)
    end associate
  end function has_earlier

  !> The checkpoint of the old mesh that the new one is made from in this way.
  pure function old_state(s, way) result(file)
    type(situation_t), intent(in) :: s
    character(len=*), intent(in) :: way
    type(checkpoint_file_t) :: file

    file = s%new%old_end
    if (way == way_earlier) file = s%new%old_earlier
    if (way == way_anew) file = s%new%old_source
  end function old_state

  pure function cannot_go_on(s)
    type(situation_t), intent(in) :: s
    logical :: cannot_go_on

    cannot_go_on = must_be_replaced(s%new%old_end%facts) .or. is_first_mesh(s%new%old_end%facts)
  end function cannot_go_on

  !> It was decided that the old mesh goes on from this stop.
  pure function old_mesh_goes_on(s) result(goes_on)
    type(situation_t), intent(in) :: s
    logical :: goes_on

    goes_on = keeps_old_mesh(s%rows, s%new%generation, s%new%old_end%facts%step) .and. .not. cannot_go_on(s)
  end function old_mesh_goes_on

  !> The try's checkpoint is whole, with its facts, and of the right generation and instant.
  !> A mesh that never carried a load is in equilibrium.
  pure function is_whole(s, way) result(whole)
    type(situation_t), intent(in) :: s
    character(len=*), intent(in) :: way
    logical :: whole
    type(checkpoint_file_t) :: old

    whole = is_read(s%new%made) .and. s%new%has_facts
    if (.not. whole) return
    old = old_state(s, way)
    associate (made => s%new%made%facts)
      whole = made%generation == s%new%generation .and. made%step == old%facts%step &
              .and. (made%unbalanced .or. is_first_mesh(old%facts))
    end associate
  end function is_whole

end module cycle_ways
