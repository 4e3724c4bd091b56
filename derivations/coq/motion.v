(* The flights of x'' = -s^j from the wall x = 0 (and, with the other sign of x, of x'' = s^j): their velocities of
   launch and landing from the equation of motion; that these are the forms of `ratios` before the contact at s = 0;
   that the hit is the first; and the fates of such orbits, for every j. *)

From Coq Require Import Reals Lra Lia.
From Contact Require Import ratios fates homogeneous behind.
Open Scope R_scope.

Lemma linear a u : derivable_pt_lim (fun w => a * w) u a.
Proof.
  assert (W := derivable_pt_lim_scal (fun w => w) a u 1 (derivable_pt_lim_id u)). now rewrite Rmult_1_r in W.
Qed.

Section Motion.

Variables (j : nat) (sigma t : R).

(* launched at the time sigma, after the time u; it is at the wall again at u = t *)
Definition x (u : R) : R := u * launch j sigma t - u * launch j sigma u.
Definition speed (u : R) : R := launch j sigma t - ((sigma + u) ^ (j + 1) - sigma ^ (j + 1)) / INR (j + 1).

Lemma shifted_power n u : derivable_pt_lim (fun u => (sigma + u) ^ S n) u (INR (S n) * (sigma + u) ^ n).
Proof.
  replace (INR (S n) * (sigma + u) ^ n) with (INR (S n) * (sigma + u) ^ n * 1) by ring.
  apply (derivable_pt_lim_comp (fun u => sigma + u) (fun y => y ^ S n)).
  - replace 1 with (0 + 1) by ring.
    apply (derivable_pt_lim_plus (fun _ => sigma) (fun u => u)).
    + apply derivable_pt_lim_const.
    + apply derivable_pt_lim_id.
  - apply derivable_pt_lim_pow.
Qed.

Lemma x_is u : x u = u * launch j sigma t
  - ((sigma + u) ^ (j + 2) - sigma ^ (j + 2) - INR (j + 2) * u * sigma ^ (j + 1)) / (INR (j + 1) * INR (j + 2)).
Proof. destruct (counts j) as [A [B _]]. unfold x. rewrite <- launch_is. field. lra. Qed.

Theorem speed_is_the_rate u : derivable_pt_lim x u (speed u).
Proof.
  destruct (counts j) as [A [B _]].
  apply (derivable_pt_lim_ext (fun u => u * launch j sigma t + (/ (INR (j + 1) * INR (j + 2)))
    * ((sigma ^ (j + 2) + INR (j + 2) * sigma ^ (j + 1) * u) - (sigma + u) ^ S (j + 1)))).
  { intro w. rewrite x_is. replace (S (j + 1)) with (j + 2)%nat by lia. field. lra. }
  replace (speed u) with (launch j sigma t + (/ (INR (j + 1) * INR (j + 2)))
    * ((0 + INR (j + 2) * sigma ^ (j + 1)) - INR (S (j + 1)) * (sigma + u) ^ (j + 1)))
    by (unfold speed; replace (S (j + 1)) with (j + 2)%nat by lia; field; lra).
  apply (derivable_pt_lim_plus (fun u => u * launch j sigma t)).
  - apply (derivable_pt_lim_ext (fun w => launch j sigma t * w)); [intro; ring|apply linear].
  - apply derivable_pt_lim_scal.
    apply (derivable_pt_lim_minus (fun u => sigma ^ (j + 2) + INR (j + 2) * sigma ^ (j + 1) * u));
      [|apply shifted_power].
    apply derivable_pt_lim_plus; [apply derivable_pt_lim_const|apply linear].
Qed.

Theorem it_solves_the_equation u : derivable_pt_lim speed u (- (sigma + u) ^ j).
Proof.
  destruct (counts j) as [A _].
  apply (derivable_pt_lim_ext (fun u => (launch j sigma t + sigma ^ (j + 1) / INR (j + 1))
    - / INR (j + 1) * (sigma + u) ^ S j)).
  { intro w. unfold speed. replace (S j) with (j + 1)%nat by lia. field. lra. }
  replace (- (sigma + u) ^ j) with (0 - / INR (j + 1) * (INR (S j) * (sigma + u) ^ j))
    by (replace (S j) with (j + 1)%nat by lia; field; lra).
  apply derivable_pt_lim_minus; [apply derivable_pt_lim_const|apply derivable_pt_lim_scal, shifted_power].
Qed.

Theorem it_starts_and_ends_at_the_wall : x 0 = 0 /\ x t = 0 /\ speed 0 = launch j sigma t
  /\ speed t = - landing j sigma t.
Proof.
  destruct (counts j) as [A [B _]]. unfold x, speed, landing. rewrite slope_is.
  repeat split; try ring; replace (sigma + 0) with sigma by ring; field; lra.
Qed.

(* nowhere between: behind the contact *)
Theorem it_comes_back_once u : 0 < sigma -> 0 < u < t -> 0 < x u.
Proof. intros Hs Hu. assert (W := launch_rises j sigma u t Hs Hu). unfold x. nra. Qed.

End Motion.

(* ---- before the contact: sigma = -S, a landing at -l S *)

Lemma P_closed j l : (1 - l) ^ 2 * P j l = INR (j + 1) - INR (j + 2) * l + l ^ (j + 2).
Proof.
  induction j as [|k IH]; [simpl; ring|].
  change (P (S k) l) with (P k l + powers (S k) l). rewrite Rmult_plus_distr_l, IH.
  replace ((1 - l) ^ 2 * powers (S k) l) with ((1 - l) * ((1 - l) * powers (S k) l)) by ring. rewrite geometric.
  replace (S k + 1)%nat with (S (k + 1)) by lia. replace (S k + 2)%nat with (S (S (k + 1))) by lia.
  replace (k + 2)%nat with (S (k + 1)) by lia. replace (S (S k)) with (S (k + 1)) by lia.
  rewrite !S_INR. simpl (l ^ S _). ring.
Qed.

Lemma Q_closed j l : (1 - l) ^ 2 * Q j l = 1 - INR (j + 2) * l ^ (j + 1) + INR (j + 1) * l ^ (j + 2).
Proof.
  induction j as [|k IH]; [simpl; ring|].
  change (Q (S k) l) with (Q k l + INR (S (S k)) * l ^ S k). rewrite Rmult_plus_distr_l, IH.
  replace (S k + 1)%nat with (S (k + 1)) by lia. replace (S k + 2)%nat with (S (S (k + 1))) by lia.
  replace (k + 2)%nat with (S (k + 1)) by lia. replace (S k) with (k + 1)%nat by lia.
  rewrite !S_INR. simpl (l ^ S _). ring.
Qed.

Lemma of_minus n y : (- y) ^ n = (-1) ^ n * y ^ n.
Proof. replace (- y) with (-1 * y) by ring. apply Rpow_mult_distr. Qed.

Section Before.

Variables (j : nat) (s : R).
Hypothesis s_positive : 0 < s.
Let b := (-1) ^ j / (INR (j + 1) * INR (j + 2)).

Theorem launch_before l : l < 1 -> launch j (- s) ((1 - l) * s) = b * s ^ (j + 1) * ((1 - l) * P j l).
Proof.
  intro H. destruct (counts j) as [A [B _]].
  apply (Rmult_eq_reg_l ((1 - l) * s * (INR (j + 1) * INR (j + 2)))); [|apply Rgt_not_eq; apply Rmult_lt_0_compat; nra].
  replace ((1 - l) * s * (INR (j + 1) * INR (j + 2)) * launch j (- s) ((1 - l) * s))
    with ((1 - l) * s * launch j (- s) ((1 - l) * s) * (INR (j + 1) * INR (j + 2))) by ring.
  unfold b.
  replace ((1 - l) * s * (INR (j + 1) * INR (j + 2))
    * ((-1) ^ j / (INR (j + 1) * INR (j + 2)) * s ^ (j + 1) * ((1 - l) * P j l)))
    with ((-1) ^ j * (s * s ^ (j + 1)) * ((1 - l) ^ 2 * P j l)) by (field; lra).
  rewrite P_closed, launch_is.
  replace (- s + (1 - l) * s) with (- (l * s)) by ring. rewrite !of_minus, Rpow_mult_distr.
  replace (j + 2)%nat with (S (S j)) by lia. replace (j + 1)%nat with (S j) by lia.
  rewrite (S_INR (S j)). simpl ((-1) ^ S _). simpl (s ^ S _). simpl (l ^ S _). ring.
Qed.

Theorem landing_before l : l < 1 -> landing j (- s) ((1 - l) * s) = b * s ^ (j + 1) * ((1 - l) * Q j l).
Proof.
  intro H. destruct (counts j) as [A [B _]].
  apply (Rmult_eq_reg_l ((1 - l) * s * (INR (j + 1) * INR (j + 2)))); [|apply Rgt_not_eq; apply Rmult_lt_0_compat; nra].
  replace ((1 - l) * s * (INR (j + 1) * INR (j + 2)) * landing j (- s) ((1 - l) * s))
    with ((1 - l) * s * landing j (- s) ((1 - l) * s) * (INR (j + 1) * INR (j + 2))) by ring.
  unfold b.
  replace ((1 - l) * s * (INR (j + 1) * INR (j + 2))
    * ((-1) ^ j / (INR (j + 1) * INR (j + 2)) * s ^ (j + 1) * ((1 - l) * Q j l)))
    with ((-1) ^ j * (s * s ^ (j + 1)) * ((1 - l) ^ 2 * Q j l)) by (field; lra).
  rewrite Q_closed, landing_is.
  replace (- s + (1 - l) * s) with (- (l * s)) by ring. rewrite !of_minus, !Rpow_mult_distr.
  replace (j + 2)%nat with (S (S j)) by lia. replace (j + 1)%nat with (S j) by lia.
  rewrite (S_INR (S j)). simpl ((-1) ^ S _). simpl (s ^ S _). simpl (l ^ S _). ring.
Qed.

(* off the wall between launch and landing, and on one side of it: the first hit *)
Theorem it_comes_back_once_before l m : 0 <= l < m -> m < 1 -> 0 < (-1) ^ j * x j (- s) ((1 - l) * s) ((1 - m) * s).
Proof.
  intros Hl Hm. destruct (counts j) as [A [B _]]. unfold x. rewrite (launch_before l), (launch_before m) by lra.
  fold (D j l) (D j m).
  assert (falls := launch_decreases j l m (proj1 Hl) (proj2 Hl)).
  assert (sign : (-1) ^ j * b = / (INR (j + 1) * INR (j + 2))).
  { unfold b. assert (square : (-1) ^ j * (-1) ^ j = 1) by (rewrite <- Rpow_mult_distr;
      replace (-1 * -1) with 1 by ring; apply pow1). unfold Rdiv. rewrite <- Rmult_assoc, square. ring. }
  replace ((-1) ^ j * ((1 - m) * s * (b * s ^ (j + 1) * D j l) - (1 - m) * s * (b * s ^ (j + 1) * D j m)))
    with ((-1) ^ j * b * ((1 - m) * s * s ^ (j + 1) * (D j l - D j m))) by ring.
  rewrite sign. assert (0 < s ^ (j + 1)) by now apply pow_lt.
  apply Rmult_lt_0_compat; [apply Rinv_0_lt_compat; nra|].
  apply Rmult_lt_0_compat; [apply Rmult_lt_0_compat; nra|lra].
Qed.

End Before.

(* ---- the fates of `homogeneous`, of motions: a launch has r times the speed of the landing before it *)

Theorem fates_of_motions j r lambda (s l : nat -> R) :
  0 < r < 1 -> 0 < lambda < 1 -> lambda ^ S j * P j lambda = r * Q j lambda ->
  0 < s 0%nat -> (forall n, 0 < l n < 1) -> (forall n, s (S n) = l n * s n) ->
  (forall n, launch j (- s (S n)) ((1 - l (S n)) * s (S n)) = r * landing j (- s n) ((1 - l n) * s n)) ->
  (lambda < l 0%nat -> exists rest, 0 < rest < s 0%nat /\ Un_cv s rest /\ Un_cv l 1) /\
  ~ l 0%nat < lambda /\
  (l 0%nat = lambda -> forall n, l n = lambda).
Proof.
  intros Hr Hlambda invariant start ratio next reset. apply (fates j r); auto.
  intro n. assert (s_positive : forall k, 0 < s k).
  { induction k as [|k IH]; [exact start|]. rewrite next. apply Rmult_lt_0_compat; [apply ratio|exact IH]. }
  assert (W := reset n). rewrite (launch_before j (s (S n))), (landing_before j (s n)) in W;
    try apply s_positive; try apply ratio.
  destruct (counts j) as [A [B _]].
  assert (sign : (-1) ^ j <> 0) by (apply pow_nonzero; lra).
  rewrite next, Rpow_mult_distr in W. unfold D. replace (S j) with (j + 1)%nat by lia.
  assert (power : 0 < s n ^ (j + 1)) by (apply pow_lt; apply s_positive).
  apply (Rmult_eq_reg_l ((-1) ^ j / (INR (j + 1) * INR (j + 2)) * s n ^ (j + 1))).
  - transitivity ((-1) ^ j / (INR (j + 1) * INR (j + 2)) * (l n ^ (j + 1) * s n ^ (j + 1))
      * ((1 - l (S n)) * P j (l (S n)))); [ring|]. rewrite W. ring.
  - apply Rmult_integral_contrapositive_currified; [|lra].
    apply Rmult_integral_contrapositive_currified; [exact sign|]. apply Rgt_not_eq, Rinv_0_lt_compat. nra.
Qed.

(* nothing is assumed but the axioms of Coq's real numbers *)
Print Assumptions it_comes_back_once_before.
Print Assumptions fates_of_motions.
