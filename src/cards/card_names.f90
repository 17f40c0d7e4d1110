!> Names that cards define and others refer to: each once, each used.
module card_names
  use deck_cursor, only: cursor_t
  use diagnostics, only: diagnostics_t, location_t
  use text, only: add_text, nearest_word, string_t, upper_case
  implicit none
  private
  public :: names_t

  character(len=*), parameter :: letters = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz'
  character(len=*), parameter :: name_letters = letters//'0123456789_-'
  integer, parameter :: longest_name = 32
  !> Words which mean something else where a name may stand.
  character(len=5), parameter :: reserved(2) = ['NODE ', 'POINT']

  !> Names of one kind, such as those of all laws.
  type :: names_t
    type(string_t), allocatable :: words(:)
    !> Keyword of the card that defines it, and its place.
    type(string_t), allocatable :: keywords(:)
    type(location_t), allocatable :: location(:)
    !> Number of the thing named in a list of the scene.
    integer, allocatable :: item(:)
    logical, allocatable :: used(:)
  contains
    procedure :: clear
    procedure :: define
    procedure :: find
    procedure :: mention
    procedure :: refuse_unused
  end type names_t

contains

  subroutine clear(self)
    class(names_t), intent(inout) :: self

    if (allocated(self%words)) deallocate (self%words, self%keywords, self%location, self%item, self%used)
    allocate (self%words(0), self%keywords(0), self%location(0), self%item(0), self%used(0))
  end subroutine clear

  !> Read a new name. After a mistake (no name, or one that exists) nothing is added and `word` is empty.
  subroutine define(self, cursor, what, keyword, item, diagnostics, word)
    class(names_t), intent(inout) :: self
    type(cursor_t), intent(inout) :: cursor
    character(len=*), intent(in) :: what, keyword
    integer, intent(in) :: item
    type(diagnostics_t), intent(in), target :: diagnostics
    character(len=:), allocatable, intent(out) :: word
    type(string_t) :: entry_word, entry_keyword
    integer :: k

    call cursor%word(what, word)
    if (cursor%failed()) return
    if (verify(word(1:1), letters) > 0 .or. verify(word, name_letters) > 0 .or. len(word) > longest_name) then
      call cursor%fail('a name is a letter, then at most 31 letters, digits, ''_'' or ''-'', found '''//word//'''')
    else if (any(reserved == upper_case(word))) then
      call cursor%fail(''''//word//''' has a meaning of its own, take another name')
    end if
    do k = 1, size(self%words)
      if (self%words(k)%s == word) call cursor%fail('the name '''//word//''' is taken by the '//self%keywords(k)%s//' at ' &
                                                    //diagnostics%place(self%location(k)))
    end do
    if (cursor%failed()) then
      word = ''
      return
    end if
    entry_word%s = word
    entry_keyword%s = keyword
    self%words = [self%words, entry_word]
    self%keywords = [self%keywords, entry_keyword]
    self%location = [self%location, cursor%where()]
    self%item = [self%item, item]
    self%used = [self%used, .false.]
  end subroutine define

  !> Read the name of a thing that some card defines: its number in `words`, 0 after a mistake. Where names of some cards are meant
  !> the message proposes these alone; another name is found too, and it is for the caller to refuse it.
  subroutine find(self, cursor, what, k, of, not_of)
    class(names_t), intent(inout) :: self
    type(cursor_t), intent(inout) :: cursor
    character(len=*), intent(in) :: what
    integer, intent(out) :: k
    character(len=*), intent(in), optional :: of, not_of   !! keywords of cards that are meant, or are not, with blanks between
    type(string_t), allocatable :: meant(:)
    character(len=:), allocatable :: word
    integer :: i

    allocate (meant(0))
    do i = 1, size(self%words)
      if (present(of)) then
        if (.not. is_among(self%keywords(i)%s, of)) cycle
      end if
      if (present(not_of)) then
        if (is_among(self%keywords(i)%s, not_of)) cycle
      end if
      call add_text(meant, self%words(i)%s)
    end do
    word = cursor%peek_word()
    call cursor%name(what, self%words, k, meant)
    if (k > 0) then
      self%used(k) = .true.
    else if (word /= '') then
      ! The name that was meant is not reported as unused as well.
      call self%mention(nearest_word(word, self%words))
    end if
  end subroutine find

  pure function is_among(keyword, keywords) result(yes)
    character(len=*), intent(in) :: keyword, keywords
    logical :: yes

    yes = index(' '//keywords//' ', ' '//keyword//' ') > 0
  end function is_among

  !> A word on a card that could not be read to its end: if it is a name, it counts as used.
  subroutine mention(self, word)
    class(names_t), intent(inout) :: self
    character(len=*), intent(in) :: word
    integer :: k

    do k = 1, size(self%words)
      if (self%words(k)%s == word) self%used(k) = .true.
    end do
  end subroutine mention

  !> An error for each name that a card with this keyword defines and no card uses.
  subroutine refuse_unused(self, keyword, advice, diagnostics)
    class(names_t), intent(in) :: self
    character(len=*), intent(in) :: keyword, advice
    type(diagnostics_t), intent(inout) :: diagnostics
    integer :: k

    do k = 1, size(self%words)
      if (self%used(k) .or. self%keywords(k)%s /= keyword) cycle
      call diagnostics%add(self%location(k), keyword, ''''//self%words(k)%s//''' is defined and never used'//advice)
    end do
  end subroutine refuse_unused

end module card_names
