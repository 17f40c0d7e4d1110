!> SHA-256 of a text in one call, or of a file piece by piece: the fingerprint of a deck, of a checkpoint.
!> Source: FIPS 180-4, Secure Hash Standard, section 6.2.
!>
!>     type(sha256_t) :: hash
!>     call hash%add(bytes)       ! as often as there are pieces
!>     digest = hash%digest()     ! of all bytes so far
!>
!> The 32-bit words live in the lower half of 64-bit integers and are cut back by `low` after each
!> sum. A word copied into both halves turns a rotation into one shift; the bits that this leaves
!> above the word, two places or more below the sign, make no sum overflow, and are cut off with it.
module hash
  use kinds, only: i8
  implicit none
  private
  public :: sha256, sha256_length, sha256_t

  !> Number of hexadecimal digits of a fingerprint.
  integer, parameter :: sha256_length = 64
  !> Bytes that are worked into the state at a time.
  integer, parameter :: block_size = 64

  integer(i8), parameter :: low = int(z'FFFFFFFF', i8)

  !> First 32 bits of the fractional parts of the square roots of the first 8 primes (5.3.3).
  integer(i8), parameter :: initial(0:7) = [ &
    int(z'6A09E667', i8), int(z'BB67AE85', i8), int(z'3C6EF372', i8), int(z'A54FF53A', i8), &
    int(z'510E527F', i8), int(z'9B05688C', i8), int(z'1F83D9AB', i8), int(z'5BE0CD19', i8)]

  !> First 32 bits of the fractional parts of the cube roots of the first 64 primes (4.2.2).
  integer(i8), parameter :: key(0:63) = [ &
    int(z'428A2F98', i8), int(z'71374491', i8), int(z'B5C0FBCF', i8), int(z'E9B5DBA5', i8), &
    int(z'3956C25B', i8), int(z'59F111F1', i8), int(z'923F82A4', i8), int(z'AB1C5ED5', i8), &
    int(z'D807AA98', i8), int(z'12835B01', i8), int(z'243185BE', i8), int(z'550C7DC3', i8), &
    int(z'72BE5D74', i8), int(z'80DEB1FE', i8), int(z'9BDC06A7', i8), int(z'C19BF174', i8), &
    int(z'E49B69C1', i8), int(z'EFBE4786', i8), int(z'0FC19DC6', i8), int(z'240CA1CC', i8), &
    int(z'2DE92C6F', i8), int(z'4A7484AA', i8), int(z'5CB0A9DC', i8), int(z'76F988DA', i8), &
    int(z'983E5152', i8), int(z'A831C66D', i8), int(z'B00327C8', i8), int(z'BF597FC7', i8), &
    int(z'C6E00BF3', i8), int(z'D5A79147', i8), int(z'06CA6351', i8), int(z'14292967', i8), &
    int(z'27B70A85', i8), int(z'2E1B2138', i8), int(z'4D2C6DFC', i8), int(z'53380D13', i8), &
    int(z'650A7354', i8), int(z'766A0ABB', i8), int(z'81C2C92E', i8), int(z'92722C85', i8), &
    int(z'A2BFE8A1', i8), int(z'A81A664B', i8), int(z'C24B8B70', i8), int(z'C76C51A3', i8), &
    int(z'D192E819', i8), int(z'D6990624', i8), int(z'F40E3585', i8), int(z'106AA070', i8), &
    int(z'19A4C116', i8), int(z'1E376C08', i8), int(z'2748774C', i8), int(z'34B0BCB5', i8), &
    int(z'391C0CB3', i8), int(z'4ED8AA4A', i8), int(z'5B9CCA4F', i8), int(z'682E6FF3', i8), &
    int(z'748F82EE', i8), int(z'78A5636F', i8), int(z'84C87814', i8), int(z'8CC70208', i8), &
    int(z'90BEFFFA', i8), int(z'A4506CEB', i8), int(z'BEF9A3F7', i8), int(z'C67178F2', i8)]

  !> A hash under way.
  type :: sha256_t
    integer(i8), private :: state(0:7) = initial
    !> Bytes taken so far; those after the last whole block wait for the rest of theirs.
    integer(i8), private :: length = 0
    character(len=1), private :: waiting(block_size) = achar(0)
  contains
    procedure :: add
    procedure :: digest
  end type sha256_t

contains

  !> Fingerprint of `text`, trailing blanks included, in lower-case hexadecimal digits.
  pure function sha256(text) result(digest)
    character(len=*), intent(in) :: text
    character(len=sha256_length) :: digest
    type(sha256_t) :: hash

    call hash%add(text)
    digest = hash%digest()
  end function sha256

  !> Take more bytes.
  pure subroutine add(self, text)
    class(sha256_t), intent(inout) :: self
    character(len=*), intent(in) :: text

    call add_bytes(self, len(text, i8), text)
  end subroutine add

  pure subroutine add_bytes(self, n, bytes)
    class(sha256_t), intent(inout) :: self
    integer(i8), intent(in) :: n
    character(len=1), intent(in) :: bytes(n)
    integer(i8) :: first, place

    place = mod(self%length, int(block_size, i8))
    self%length = self%length + n
    first = 1
    if (place > 0) then
      first = min(block_size - place, n) + 1
      self%waiting(place + 1:place + first - 1) = bytes(:first - 1)
      if (place + first - 1 < block_size) return
      call compress(self%state, self%waiting)
    end if
    do first = first, n - block_size + 1, block_size
      call compress(self%state, bytes(first:first + block_size - 1))
    end do
    self%waiting(:n - first + 1) = bytes(first:)
  end subroutine add_bytes

  !> Fingerprint of all bytes so far, in lower-case hexadecimal digits: what waits, and its padding (5.1.1).
  pure function digest(self)
    class(sha256_t), intent(in) :: self
    character(len=sha256_length) :: digest
    character(len=1) :: tail(2*block_size)
    integer(i8) :: state(0:7)
    integer :: rest, ntail, i

    rest = int(mod(self%length, int(block_size, i8)))
    ntail = merge(block_size, 2*block_size, rest < 56)
    tail = achar(0)
    tail(:rest) = self%waiting(:rest)
    tail(rest + 1) = char(128)
    do i = 0, 7
      tail(ntail - i) = char(int(ibits(8*self%length, 8*i, 8)))
    end do
    state = self%state
    do i = 1, ntail, block_size
      call compress(state, tail(i:i + block_size - 1))
    end do

    write (digest, '(8z8.8)') state
    digest = lower_hexadecimal(digest)
  end function digest

  !> Work one block of 64 bytes into the state (6.2.2).
  pure subroutine compress(state, block)
    integer(i8), intent(inout) :: state(0:7)
    character(len=1), intent(in) :: block(block_size)
    integer(i8) :: w(0:63), a, b, c, d, e, f, g, h, x, y
    integer :: t

    do t = 0, 15
      w(t) = ior(ior(shiftl(byte(4*t + 1), 24), shiftl(byte(4*t + 2), 16)), ior(shiftl(byte(4*t + 3), 8), byte(4*t + 4)))
    end do
    do t = 16, 63
      x = both_halves(w(t - 15))
      y = both_halves(w(t - 2))
      x = ieor(ieor(shiftr(x, 7), shiftr(x, 18)), shiftr(w(t - 15), 3))
      y = ieor(ieor(shiftr(y, 17), shiftr(y, 19)), shiftr(w(t - 2), 10))
      w(t) = iand(x + y + w(t - 7) + w(t - 16), low)
    end do

    a = state(0); b = state(1); c = state(2); d = state(3)
    e = state(4); f = state(5); g = state(6); h = state(7)
    do t = 0, 63, 8   ! after eight rounds every word is back in its place
      call turn(a, b, c, d, e, f, g, h, key(t) + w(t))
      call turn(h, a, b, c, d, e, f, g, key(t + 1) + w(t + 1))
      call turn(g, h, a, b, c, d, e, f, key(t + 2) + w(t + 2))
      call turn(f, g, h, a, b, c, d, e, key(t + 3) + w(t + 3))
      call turn(e, f, g, h, a, b, c, d, key(t + 4) + w(t + 4))
      call turn(d, e, f, g, h, a, b, c, key(t + 5) + w(t + 5))
      call turn(c, d, e, f, g, h, a, b, key(t + 6) + w(t + 6))
      call turn(b, c, d, e, f, g, h, a, key(t + 7) + w(t + 7))
    end do
    state = iand(state + [a, b, c, d, e, f, g, h], low)

  contains

    pure function byte(i)
      integer, intent(in) :: i
      integer(i8) :: byte

      byte = int(ichar(block(i)), i8)
    end function byte

  end subroutine compress

  !> One round: `d` and `h` become the next round's e and a; the other words only change their names.
  pure subroutine turn(a, b, c, d, e, f, g, h, added)
    integer(i8), intent(in) :: a, b, c, e, f, g
    integer(i8), intent(inout) :: d, h
    integer(i8), intent(in) :: added   !! the round's constant and word of the message
    integer(i8) :: x, y

    x = both_halves(e)
    y = both_halves(a)
    h = h + added + ieor(ieor(shiftr(x, 6), shiftr(x, 11)), shiftr(x, 25)) + ieor(g, iand(e, ieor(f, g)))
    d = iand(d + h, low)
    h = iand(h + ieor(ieor(shiftr(y, 2), shiftr(y, 13)), shiftr(y, 22)) + ior(iand(a, b), iand(c, ior(a, b))), low)
  end subroutine turn

  !> A 32-bit word written twice into 64 bits: shifting it to the right now rotates it.
  elemental function both_halves(word)
    integer(i8), intent(in) :: word
    integer(i8) :: both_halves

    both_halves = ior(word, shiftl(word, 32))
  end function both_halves

  !> Hexadecimal digits A-F in lower case, as `sha256sum` prints them.
  pure function lower_hexadecimal(digits) result(lower)
    character(len=*), intent(in) :: digits
    character(len=len(digits)) :: lower
    integer :: i

    lower = digits
    do i = 1, len(digits)
      if (digits(i:i) >= 'A') lower(i:i) = achar(iachar(digits(i:i)) + 32)
    end do
  end function lower_hexadecimal

end module hash
