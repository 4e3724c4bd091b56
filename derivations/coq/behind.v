(* Impacts behind a contact of order j, in the homogeneous model x'' = -t^j: all of them end in complete chatter; and in
   x'' = t^j no flight from there comes back.

   A flight of length t > 0 from sigma >= 0 that comes back under x'' = -s^j has the launch and landing velocities

     launch(sigma, t) = 1/t times the integral of (t - u) (sigma + u)^j over u from 0 to t,
     landing(sigma, t) = 1/t times the integral of u (sigma + u)^j,

   here in closed form.  A launch is above t sigma^j/2 and a landing below t (sigma + t)^j/2, so that each flight is at
   most r times as long as the one before. *)

From Coq Require Import Reals Lra Lia.
Open Scope R_scope.

(* ((sigma + t)^n - sigma^n)/t *)
Fixpoint slope (n : nat) (sigma t : R) : R :=
  match n with O => 0 | S k => sigma * slope k sigma t + (sigma + t) ^ k end.

Definition launch (j : nat) (sigma t : R) : R :=
  (slope (j + 2) sigma t - INR (j + 2) * sigma ^ (j + 1)) / (INR (j + 1) * INR (j + 2)).
Definition landing (j : nat) (sigma t : R) : R := t * slope (j + 1) sigma t / INR (j + 1) - launch j sigma t.

Lemma slope_is n sigma t : t * slope n sigma t = (sigma + t) ^ n - sigma ^ n.
Proof.
  induction n as [|k IH]; [simpl; ring|].
  change (slope (S k) sigma t) with (sigma * slope k sigma t + (sigma + t) ^ k).
  replace (t * (sigma * slope k sigma t + (sigma + t) ^ k))
    with (sigma * (t * slope k sigma t) + t * (sigma + t) ^ k) by ring.
  rewrite IH. simpl. ring.
Qed.

Lemma slope_grows n sigma t u : 0 <= sigma -> 0 <= t <= u -> slope n sigma t <= slope n sigma u.
Proof.
  intros Hs Ht. induction n as [|k IH]; [simpl; lra|].
  change (sigma * slope k sigma t + (sigma + t) ^ k <= sigma * slope k sigma u + (sigma + u) ^ k).
  assert ((sigma + t) ^ k <= (sigma + u) ^ k) by (apply pow_incr; lra).
  assert (sigma * slope k sigma t <= sigma * slope k sigma u) by now apply Rmult_le_compat_l. lra.
Qed.

(* strictly, from n = 2 on *)
Lemma slope_rises n sigma t u : 0 < sigma -> 0 < t < u -> slope (S (S n)) sigma t < slope (S (S n)) sigma u.
Proof.
  intros Hs Ht.
  change (sigma * slope (S n) sigma t + (sigma + t) ^ S n < sigma * slope (S n) sigma u + (sigma + u) ^ S n).
  assert (sigma * slope (S n) sigma t <= sigma * slope (S n) sigma u)
    by (apply Rmult_le_compat_l; [lra|apply slope_grows; lra]).
  assert ((sigma + t) ^ S n < (sigma + u) ^ S n); [|lra].
  simpl. assert ((sigma + t) ^ n <= (sigma + u) ^ n) by (apply pow_incr; lra).
  assert (0 < (sigma + t) ^ n) by (apply pow_lt; lra). nra.
Qed.

(* Taylor's sum to the second power from both ends *)
Lemma from_the_launch n sigma t : 0 <= sigma -> 0 <= t ->
  sigma ^ S (S n) + INR (S (S n)) * t * sigma ^ S n + INR (S (S n)) * INR (S n) / 2 * t ^ 2 * sigma ^ n
  <= (sigma + t) ^ S (S n).
Proof.
  intros Hs Ht. induction n as [|k IH]; [simpl; lra|].
  change ((sigma + t) ^ S (S (S k))) with ((sigma + t) * (sigma + t) ^ S (S k)).
  eapply Rle_trans; [|apply Rmult_le_compat_l; [lra|exact IH]].
  rewrite (S_INR (S (S k))), !(S_INR (S k)), !(S_INR k). assert (N := pos_INR k).
  assert (0 <= (INR k + 1 + 1) * (INR k + 1) / 2 * (t ^ 3 * sigma ^ k)).
  { apply Rmult_le_pos; [nra|]. apply Rmult_le_pos; now apply pow_le. }
  change (sigma ^ S (S (S k))) with (sigma * (sigma * (sigma * sigma ^ k))).
  change (sigma ^ S (S k)) with (sigma * (sigma * sigma ^ k)). change (sigma ^ S k) with (sigma * sigma ^ k). nra.
Qed.

Lemma from_the_landing n y t : 0 <= t <= y ->
  (y - t) ^ S (S n)
  <= y ^ S (S n) - INR (S (S n)) * t * y ^ S n + INR (S (S n)) * INR (S n) / 2 * t ^ 2 * y ^ n.
Proof.
  intros Ht. induction n as [|k IH]; [simpl; lra|].
  change ((y - t) ^ S (S (S k))) with ((y - t) * (y - t) ^ S (S k)).
  eapply Rle_trans; [apply Rmult_le_compat_l; [lra|exact IH]|].
  rewrite (S_INR (S (S k))), !(S_INR (S k)), !(S_INR k). assert (N := pos_INR k).
  assert (0 <= (INR k + 1 + 1) * (INR k + 1) / 2 * (t ^ 3 * y ^ k)).
  { apply Rmult_le_pos; [nra|]. apply Rmult_le_pos; apply pow_le; lra. }
  change (y ^ S (S (S k))) with (y * (y * (y * y ^ k))).
  change (y ^ S (S k)) with (y * (y * y ^ k)). change (y ^ S k) with (y * y ^ k). nra.
Qed.

Lemma counts j : 0 < INR (j + 1) /\ 0 < INR (j + 2) /\ INR (j + 2) = INR (j + 1) + 1.
Proof.
  assert (A : 0 < INR (j + 1)) by (apply lt_0_INR; lia). assert (B : 0 < INR (j + 2)) by (apply lt_0_INR; lia).
  replace (j + 2)%nat with (S (j + 1)) by lia. rewrite S_INR. lra.
Qed.

Lemma launch_is j sigma t : t * launch j sigma t * (INR (j + 1) * INR (j + 2))
  = (sigma + t) ^ (j + 2) - sigma ^ (j + 2) - INR (j + 2) * t * sigma ^ (j + 1).
Proof.
  destruct (counts j) as [A [B _]]. unfold launch. rewrite <- (slope_is (j + 2)). field. lra.
Qed.

Lemma landing_is j sigma t : t * landing j sigma t * (INR (j + 1) * INR (j + 2))
  = INR (j + 2) * t * (sigma + t) ^ (j + 1) - (sigma + t) ^ (j + 2) + sigma ^ (j + 2).
Proof.
  destruct (counts j) as [A [B C]].
  replace (t * landing j sigma t * (INR (j + 1) * INR (j + 2)))
    with (t * (t * slope (j + 1) sigma t) * INR (j + 2) - t * launch j sigma t * (INR (j + 1) * INR (j + 2)))
    by (unfold landing; field; lra).
  rewrite launch_is, slope_is. ring.
Qed.

Theorem a_launch_is_high j sigma t : 0 <= sigma -> 0 < t -> t * sigma ^ j / 2 <= launch j sigma t.
Proof.
  intros Hs Ht. destruct (counts j) as [A [B C]]. assert (E := launch_is j sigma t).
  assert (T := from_the_launch j sigma t Hs ltac:(lra)).
  replace (S (S j)) with (j + 2)%nat in T by lia. replace (S j) with (j + 1)%nat in T by lia.
  apply (Rmult_le_reg_l t); [exact Ht|]. apply (Rmult_le_reg_r (INR (j + 1) * INR (j + 2))); [nra|].
  rewrite E. lra.
Qed.

Theorem a_landing_is_low j sigma t : 0 <= sigma -> 0 < t -> landing j sigma t <= t * (sigma + t) ^ j / 2.
Proof.
  intros Hs Ht. destruct (counts j) as [A [B C]]. assert (E := landing_is j sigma t).
  assert (T := from_the_landing j (sigma + t) t ltac:(lra)). replace (sigma + t - t) with sigma in T by ring.
  replace (S (S j)) with (j + 2)%nat in T by lia. replace (S j) with (j + 1)%nat in T by lia.
  apply (Rmult_le_reg_l t); [exact Ht|]. apply (Rmult_le_reg_r (INR (j + 1) * INR (j + 2))); [nra|].
  rewrite E. lra.
Qed.

(* in x'' = t^j launch and landing have the other sign: no flight comes back *)
Theorem a_launch_is_positive j sigma t : 0 < sigma -> 0 < t -> 0 < launch j sigma t.
Proof.
  intros Hs Ht. assert (W := a_launch_is_high j sigma t ltac:(lra) Ht).
  assert (0 < sigma ^ j) by now apply pow_lt. nra.
Qed.

Lemma launch_rises j sigma t u : 0 < sigma -> 0 < t < u -> launch j sigma t < launch j sigma u.
Proof.
  intros Hs Ht. destruct (counts j) as [A [B _]]. unfold launch, Rdiv.
  apply Rmult_lt_compat_r; [apply Rinv_0_lt_compat; nra|].
  assert (W := slope_rises j sigma t u Hs Ht). replace (S (S j)) with (j + 2)%nat in W by lia. lra.
Qed.

Section Orbit.

Variables (j : nat) (r : R) (sigma t : nat -> R).
Hypothesis r_inside : 0 < r < 1.
Hypothesis start : 0 <= sigma 0%nat.
Hypothesis flight : forall n, 0 < t n.
Hypothesis next : forall n, sigma (S n) = sigma n + t n.
Hypothesis impact : forall n, launch j (sigma (S n)) (t (S n)) = r * landing j (sigma n) (t n).

Lemma sigma_not_negative n : 0 <= sigma n.
Proof. induction n as [|k IH]; [exact start|]. rewrite next. assert (W := flight k). lra. Qed.

Theorem flights_shorten n : t (S n) <= r * t n.
Proof.
  assert (Hs := sigma_not_negative n). assert (Ht := flight n). assert (Ht' := flight (S n)).
  apply Rnot_lt_le. intro F.
  assert (up : launch j (sigma (S n)) (r * t n) < launch j (sigma (S n)) (t (S n)))
    by (apply launch_rises; [rewrite next; lra|split; [nra|exact F]]).
  assert (high := a_launch_is_high j (sigma (S n)) (r * t n) (sigma_not_negative (S n)) ltac:(nra)).
  assert (low := a_landing_is_low j (sigma n) (t n) Hs Ht). rewrite <- next in low.
  assert (E := impact n). nra.
Qed.

(* impacts accumulate, no later than t/(1 - r) after the first *)
Theorem chatter_completes : exists rest, Un_cv sigma rest /\ rest <= sigma 0%nat + t 0%nat / (1 - r).
Proof.
  assert (grows : Un_growing sigma) by (intro n; rewrite next; assert (W := flight n); lra).
  assert (room : forall n, sigma n + t n / (1 - r) <= sigma 0%nat + t 0%nat / (1 - r)).
  { induction n as [|k IH]; [lra|]. eapply Rle_trans; [|exact IH]. rewrite next.
    assert (W := flights_shorten k). assert (c : 0 < / (1 - r)) by (apply Rinv_0_lt_compat; lra).
    assert (t (S k) / (1 - r) <= r * t k / (1 - r)) by (apply Rmult_le_compat_r; lra).
    replace (t k / (1 - r)) with (t k + r * t k / (1 - r)) by (field; lra). lra. }
  assert (bound : forall n, sigma n <= sigma 0%nat + t 0%nat / (1 - r)).
  { intro n. specialize (room n). assert (0 < t n / (1 - r)) by (apply Rdiv_lt_0_compat; [apply flight|lra]). lra. }
  destruct (growing_cv sigma grows) as [rest Hr].
  { exists (sigma 0%nat + t 0%nat / (1 - r)). intros x [n E]. subst x. apply bound. }
  exists rest. split; [exact Hr|]. apply Rnot_lt_le. intro F.
  destruct (Hr (rest - (sigma 0%nat + t 0%nat / (1 - r))) ltac:(lra)) as [N HN].
  specialize (HN N ltac:(lia)). specialize (bound N). unfold R_dist in HN. apply Rabs_def2 in HN. lra.
Qed.

End Orbit.

Print Assumptions chatter_completes.
