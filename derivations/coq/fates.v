(* The fates of impacts before a contact: which sequences end in complete chatter, and which leave before.

   Impacts before the contact at tau_* are written as sigma = -S; a flight from -S lands at -l S.  Let l = L(S) be the
   invariant arc gamma, and q = (1 - l)/(1 - L(S)) the length of a flight over that on the arc.  An impact multiplies q
   by T(S, l), which is below 1 where drift(S, l) > 0 and above 1 where it is < 0; the drift rises with l and vanishes
   on the arc.  Before a contact of order j it is l^(j+1) P_j/Q_j - r + O(S): see `ratios`. *)

From Coq Require Import Reals Lra Lia.
Open Scope R_scope.

(* where lengths q of flights fall by the factor rho, (1 - q/(1 - rho)) S does not *)
Lemma room_grows rho length shorter ratio : 0 < rho < 1 -> 0 < length < 1 - rho -> 0 < shorter ->
  shorter <= rho * length -> 1 - length <= ratio -> 1 - length / (1 - rho) <= ratio * (1 - shorter / (1 - rho)).
Proof.
  intros Hr Hl Hs falls near. set (c := / (1 - rho)).
  assert (c0 : 0 < c) by (apply Rinv_0_lt_compat; lra).
  assert (cr : c = 1 + c * rho) by (unfold c; field; lra).
  assert (lc : length * c < 1) by (replace 1 with ((1 - rho) * c) by (unfold c; field; lra);
    apply Rmult_lt_compat_r; lra).
  assert (sc : shorter * c <= length * c * rho).
  { replace (length * c * rho) with (rho * length * c) by ring. apply Rmult_le_compat_r; lra. }
  unfold Rdiv. fold c.
  apply Rle_trans with ((1 - length) * (1 - length * c * rho)).
  - replace ((1 - length) * (1 - length * c * rho)) with (1 - length * (1 + c * rho) + length * length * (c * rho))
      by ring.
    rewrite <- cr. assert (0 <= length * length * (c * rho)); [|lra].
    apply Rmult_le_pos; apply Rmult_le_pos; lra.
  - apply Rmult_le_compat; try lra. assert (0 < length * c) by (apply Rmult_lt_0_compat; lra). nra.
Qed.

Section Fates.

Variables (S0 lambda L1 e : R) (L : R -> R) (drift T : R -> R -> R).
Hypothesis S0_positive : 0 < S0.
Hypothesis lambda_inside : 0 < lambda < 1.
Hypothesis e_positive : 0 < e.

(* the arc: continuous at the contact *)
Hypothesis L_at_0 : L 0 = lambda.
Hypothesis L_inside : forall s, 0 <= s <= S0 -> 0 < L s <= L1.
Hypothesis L1_below : L1 < 1.
Hypothesis L_continuous : forall eps, 0 < eps -> exists d, 0 < d /\
  forall s, 0 <= s <= S0 -> s < d -> Rabs (L s - lambda) < eps.

(* on which side of the arc flights grow beside those on it, and by which factor, continuous at S = 0 *)
Hypothesis drift_rises : forall s x y, 0 <= s <= S0 -> 0 < x -> x < y -> y <= 1 -> drift s x < drift s y.
Hypothesis drift_on_the_arc : forall s, 0 <= s <= S0 -> drift s (L s) = 0.
Hypothesis T_below_1 : forall s l, 0 <= s <= S0 -> 0 < l <= 1 -> 0 < drift s l -> T s l < 1.
Hypothesis T_above_1 : forall s l, 0 <= s <= S0 -> 0 < l <= 1 -> drift s l < 0 -> 1 < T s l.
Hypothesis T_continuous : forall m, 0 < m <= 1 -> forall eps, 0 < eps -> exists d, 0 < d /\
  forall s l, 0 <= s <= S0 -> s < d -> 0 < l <= 1 -> Rabs (l - m) < d -> Rabs (T s l - T 0 m) < eps.

(* an orbit with infinitely many impacts before the contact *)
Variables s l : nat -> R.
Hypothesis start : 0 < s 0%nat <= S0.
Hypothesis ratio : forall n, 0 < l n < 1.
Hypothesis next : forall n, s (S n) = l n * s n.
Definition q n := (1 - l n) / (1 - L (s n)).
Hypothesis impact : forall n, q (S n) = T (s n) (l n) * q n.
(* a flight that lands next to the contact is followed by none that lands before it *)
Hypothesis last : forall n, s n < e -> e <= l n.

Lemma T_falls x y : 0 <= x <= S0 -> L x < y <= 1 -> T x y < 1.
Proof.
  intros Hx Hy. assert (I := L_inside x Hx). apply T_below_1; [exact Hx|lra|].
  rewrite <- (drift_on_the_arc x Hx). apply drift_rises; lra.
Qed.

Lemma T_grows x y : 0 <= x <= S0 -> 0 < y < L x -> 1 < T x y.
Proof.
  intros Hx Hy. assert (I := L_inside x Hx). apply T_above_1; [exact Hx|lra|].
  rewrite <- (drift_on_the_arc x Hx). apply drift_rises; lra.
Qed.

Lemma limit_not_negative (u : nat -> R) k : (forall n, 0 < u n) -> Un_cv u k -> 0 <= k.
Proof.
  intros P H. apply Rnot_lt_le. intro F. destruct (H (- k) ltac:(lra)) as [N HN].
  specialize (HN N ltac:(lia)). specialize (P N). unfold R_dist in HN. apply Rabs_def2 in HN. lra.
Qed.

Lemma s_inside n : 0 < s n <= S0.
Proof. induction n as [|k IH]; [exact start|]. rewrite next. assert (H := ratio k). nra. Qed.

Lemma L_of n : 0 < L (s n) <= L1.
Proof. apply L_inside. assert (H := s_inside n). lra. Qed.

Lemma q_of n : 1 - l n = q n * (1 - L (s n)).
Proof. unfold q. assert (H := L_of n). field. lra. Qed.

Lemma q_positive n : 0 < q n.
Proof. unfold q. apply Rdiv_lt_0_compat; [assert (H := ratio n)|assert (H := L_of n)]; lra. Qed.

Lemma s_falls : Un_decreasing s.
Proof. intro n. rewrite next. assert (H := ratio n). assert (K := s_inside n). nra. Qed.

(* where S tends to 0, so does L to lambda, l to 1 - q (1 - lambda), and T to its value there *)
Lemma L_tends : Un_cv s 0 -> Un_cv (fun n => L (s n)) lambda.
Proof.
  intros H eps He. destruct (L_continuous eps He) as [d [Hd K]]. destruct (H d Hd) as [N HN].
  exists N. intros n Hn. specialize (HN n Hn). unfold R_dist in *. assert (I := s_inside n).
  apply K; [lra|]. rewrite Rminus_0_r, Rabs_right in HN; lra.
Qed.

Lemma l_tends k : Un_cv s 0 -> Un_cv q k -> Un_cv l (1 - k * (1 - lambda)).
Proof.
  intros H K.
  assert (one : Un_cv (fun _ => 1) 1).
  { intros eps He. exists 0%nat. intros. unfold R_dist. now rewrite Rminus_diag_eq, Rabs_R0. }
  assert (G := CV_minus _ _ _ _ one (CV_mult _ _ _ _ K (CV_minus _ _ _ _ one (L_tends H)))).
  intros eps He. destruct (G eps He) as [N HN]. exists N. intros n Hn. specialize (HN n Hn).
  assert (E := q_of n). now replace (l n) with (1 - q n * (1 - L (s n))) by lra.
Qed.

Lemma T_tends m : 0 < m <= 1 -> Un_cv s 0 -> Un_cv l m -> Un_cv (fun n => T (s n) (l n)) (T 0 m).
Proof.
  intros Hm H K eps He. destruct (T_continuous m Hm eps He) as [d [Hd C]].
  destruct (H d Hd) as [N HN]. destruct (K d Hd) as [M HM]. exists (max N M). intros n Hn.
  specialize (HN n ltac:(lia)). specialize (HM n ltac:(lia)). unfold R_dist in *.
  assert (I := s_inside n). assert (J := ratio n).
  apply C; try lra. rewrite Rminus_0_r, Rabs_right in HN; lra.
Qed.

(* ---- flights that are shorter than on the arc *)

Section Below.
Hypothesis below : L (s 0%nat) < l 0%nat.

Lemma q_below n : q n < 1 /\ q n <= q 0%nat.
Proof.
  induction n as [|k [IH1 IH2]].
  - split; [|lra]. unfold q. assert (H := L_of 0). apply (Rmult_lt_reg_r (1 - L (s 0%nat))); [lra|].
    unfold Rdiv. rewrite Rmult_assoc, Rinv_l; lra.
  - assert (P := q_positive k). assert (I := s_inside k). assert (J := ratio k). assert (E := q_of k).
    assert (K := L_of k).
    assert (F : T (s k) (l k) < 1) by (apply T_falls; [lra|split; nra]).
    rewrite impact. split; nra.
Qed.

Lemma q_falls : Un_decreasing q.
Proof.
  intro n. destruct (q_below n) as [H _]. assert (P := q_positive n). assert (I := s_inside n).
  assert (J := ratio n). assert (E := q_of n). assert (K := L_of n). rewrite impact.
  assert (F : T (s n) (l n) < 1) by (apply T_falls; [lra|split; nra]). nra.
Qed.

(* S does not tend to 0: its lengths q would fall like powers, and S (1 - q/(1 - rho)) would grow in the end *)
Lemma s_stays : ~ Un_cv s 0.
Proof.
  intro H.
  destruct (decreasing_cv q q_falls) as [k Hk].
  { exists 0. intros x [n E]. unfold opp_seq in E. assert (P := q_positive n). lra. }
  assert (k0 : 0 <= k) by exact (limit_not_negative q k q_positive Hk).
  assert (k1 : k <= q 0%nat) by (apply decreasing_ineq with (Un := q); [exact q_falls|exact Hk]).
  destruct (q_below 0) as [B _].
  set (m := 1 - k * (1 - lambda)).
  assert (Hm : lambda < m <= 1) by (unfold m; split; nra).
  assert (G := T_tends m ltac:(lra) H (l_tends k H Hk)).
  assert (F : T 0 m < 1) by (apply T_falls; [lra|rewrite L_at_0; lra]).
  destruct (G ((1 - T 0 m) / 2) ltac:(lra)) as [N HN].
  set (rho := (1 + T 0 m) / 2).
  assert (step : forall n, (n >= N)%nat -> q (S n) <= rho * q n).
  { intros n Hn. rewrite impact. apply Rmult_le_compat_r; [left; apply q_positive|].
    specialize (HN n Hn). unfold R_dist in HN. apply Rabs_def2 in HN. unfold rho. lra. }
  assert (rho0 : 0 < rho).
  { specialize (step N ltac:(lia)). assert (P := q_positive N). assert (P' := q_positive (S N)). nra. }
  assert (rho1 : rho < 1) by (unfold rho; lra).
  assert (power : forall i, q (N + i)%nat <= rho ^ i * q N).
  { induction i as [|i IH]; [rewrite Nat.add_0_r; simpl; lra|].
    rewrite Nat.add_succ_r. specialize (step (N + i)%nat ltac:(lia)). simpl.
    assert (rho * q (N + i)%nat <= rho * (rho ^ i * q N)) by (apply Rmult_le_compat_l; lra). lra. }
  destruct (pow_lt_1_zero rho) with (y := (1 - rho) / 2) as [J HJ]; [rewrite Rabs_right; lra|lra|].
  assert (small : q (N + J)%nat < (1 - rho) / 2).
  { specialize (HJ J ltac:(lia)). rewrite Rabs_right in HJ by (apply Rle_ge, pow_le; lra).
    specialize (power J). destruct (q_below N) as [B' _]. assert (P := q_positive N).
    assert (0 < rho ^ J) by (apply pow_lt; lra). nra. }
  set (M := (N + J)%nat) in *.
  set (U := fun n => s n * (1 - q n / (1 - rho))).
  assert (grows : forall i, U M <= U (M + i)%nat).
  { induction i as [|i IH]; [rewrite Nat.add_0_r; lra|]. eapply Rle_trans; [exact IH|]. unfold U.
    rewrite Nat.add_succ_r, next. specialize (step (M + i)%nat ltac:(unfold M; lia)).
    set (n := (M + i)%nat) in *. assert (P := q_positive n). assert (E := q_of n). assert (K := L_of n).
    assert (I := s_inside n). assert (P' := q_positive (S n)). assert (R' := ratio n).
    assert (short : q n < (1 - rho)).
    { assert (D : forall i, q (M + i)%nat <= q M).
      { induction i0 as [|a IHa]; [rewrite Nat.add_0_r; lra|]. rewrite Nat.add_succ_r.
        assert (W := q_falls (M + a)%nat). lra. }
      specialize (D i). fold n in D. lra. }
    assert (W : 1 - q n / (1 - rho) <= l n * (1 - q (S n) / (1 - rho))) by (apply room_grows; nra).
    replace (l n * s n * (1 - q (S n) / (1 - rho))) with (s n * (l n * (1 - q (S n) / (1 - rho)))) by ring.
    apply Rmult_le_compat_l; lra. }
  assert (UM : 0 < U M).
  { unfold U. apply Rmult_lt_0_compat; [apply s_inside|].
    assert (q M / (1 - rho) < 1); [|lra]. apply (Rmult_lt_reg_r (1 - rho)); [lra|].
    unfold Rdiv. rewrite Rmult_assoc, Rinv_l; lra. }
  destruct (H (U M) UM) as [A HA]. specialize (HA (M + A)%nat ltac:(lia)). specialize (grows A).
  unfold R_dist in HA. assert (I := s_inside (M + A)). rewrite Rminus_0_r, Rabs_right in HA by lra.
  unfold U in grows at 2.
  assert (0 < q (M + A)%nat / (1 - rho)) by (apply Rdiv_lt_0_compat; [apply q_positive|lra]). nra.
Qed.

(* impacts accumulate at a time before the contact, and flight times fall beside S: complete chatter *)
Theorem chatter_is_complete : exists rest, 0 < rest < s 0%nat /\ Un_cv s rest /\ Un_cv l 1.
Proof.
  destruct (decreasing_cv s s_falls) as [rest Hr].
  { exists 0. intros x [n E]. unfold opp_seq in E. assert (I := s_inside n). lra. }
  assert (least : forall n, rest <= s n) by (intro; apply decreasing_ineq; [exact s_falls|exact Hr]).
  assert (r0 : 0 <= rest) by exact (limit_not_negative s rest (fun n => proj1 (s_inside n)) Hr).
  destruct r0 as [r0|r0]; [|exfalso; apply s_stays; now rewrite r0].
  exists rest. split; [split; [exact r0|]|split; [exact Hr|]].
  - specialize (least 1%nat). rewrite next in least. assert (J := ratio 0). assert (I := s_inside 0). nra.
  - intros eps He. destruct (Hr (eps * rest / 2) ltac:(nra)) as [N HN]. exists N. intros n Hn.
    assert (A := HN n Hn). assert (B := HN (S n) ltac:(lia)). unfold R_dist in *.
    assert (I := least n). assert (I' := least (S n)). assert (J := ratio n).
    rewrite Rabs_right in A by lra. rewrite Rabs_right in B by lra. rewrite next in *.
    rewrite Rabs_left by lra. nra.
Qed.
End Below.

(* ---- flights that are longer than on the arc *)

Theorem impacts_before_the_contact_end : ~ l 0%nat < L (s 0%nat).
Proof.
  intro above.
  assert (longer : forall n, 1 < q n /\ q 0%nat <= q n).
  { induction n as [|k [IH1 IH2]].
    - split; [|lra]. unfold q. assert (H := L_of 0). apply (Rmult_lt_reg_r (1 - L (s 0%nat))); [lra|].
      unfold Rdiv. rewrite Rmult_assoc, Rinv_l; lra.
    - assert (I := s_inside k). assert (J := ratio k). assert (E := q_of k). assert (K := L_of k).
      assert (F : 1 < T (s k) (l k)) by (apply T_grows; [lra|split; nra]). rewrite impact. split; nra. }
  assert (short : forall n, l n < L1).
  { intro n. destruct (longer n) as [B _]. assert (E := q_of n). assert (K := L_of n). nra. }
  assert (to0 : Un_cv s 0).
  { assert (L0 : 0 < L1) by (assert (J := ratio 0); specialize (short 0%nat); lra).
    assert (power : forall n, s n <= L1 ^ n * S0).
    { induction n as [|k IH]; [simpl; lra|]. rewrite next. specialize (short k). assert (J := ratio k).
      assert (I := s_inside k). simpl. rewrite Rmult_assoc. apply Rmult_le_compat; lra. }
    intros eps He. destruct (pow_lt_1_zero L1) with (y := eps / S0) as [N HN];
      [rewrite Rabs_right; lra|now apply Rdiv_lt_0_compat|].
    exists N. intros n Hn. specialize (HN n Hn). specialize (power n). assert (I := s_inside n).
    unfold R_dist. rewrite Rminus_0_r, Rabs_right by lra.
    rewrite Rabs_right in HN by (apply Rle_ge, pow_le; lra).
    apply Rle_lt_trans with (L1 ^ n * S0); [exact power|]. apply (Rmult_lt_compat_r S0) in HN; [|lra].
    unfold Rdiv in HN. rewrite Rmult_assoc, Rinv_l in HN; lra. }
  assert (growing : Un_growing q).
  { intro n. destruct (longer n) as [B _]. assert (I := s_inside n). assert (J := ratio n). assert (E := q_of n).
    assert (K := L_of n). rewrite impact.
    assert (F : 1 < T (s n) (l n)) by (apply T_grows; [lra|split; nra]). nra. }
  destruct (growing_cv q growing) as [k Hk].
  { exists (/ (1 - L1)). intros x [n E]. subst x. assert (J := ratio n). assert (E := q_of n). assert (K := L_of n).
    assert (G := q_positive n). apply (Rmult_le_reg_r (1 - L1)); [lra|]. rewrite Rinv_l by lra. nra. }
  assert (k1 : q 0%nat <= k) by now apply growing_ineq.
  destruct (longer 0%nat) as [B _].
  set (m := 1 - k * (1 - lambda)).
  assert (lm := l_tends k to0 Hk). fold m in lm.
  assert (em : e <= m).
  { apply Rnot_lt_le. intro F. destruct (lm (e - m) ltac:(lra)) as [N HN]. destruct (to0 e e_positive) as [M HM].
    specialize (HN (max N M) ltac:(lia)). specialize (HM (max N M) ltac:(lia)). unfold R_dist in *.
    assert (I := s_inside (max N M)). rewrite Rminus_0_r, Rabs_right in HM by lra.
    assert (W := last (max N M) HM). apply Rabs_def2 in HN. lra. }
  assert (Hm : 0 < m < lambda) by (unfold m in *; split; nra).
  assert (F : 1 < T 0 m) by (apply T_grows; [lra|rewrite L_at_0; lra]).
  set (rise := (T 0 m - 1)).
  destruct (T_tends m ltac:(lra) to0 lm (rise / 2) ltac:(unfold rise; lra)) as [A HA].
  destruct (Hk (rise / 4) ltac:(unfold rise; lra)) as [C HC].
  set (n := max A C). specialize (HA n ltac:(lia)).
  assert (one := HC n ltac:(lia)). assert (two := HC (S n) ltac:(lia)). unfold R_dist in *.
  apply Rabs_def2 in HA. apply Rabs_def2 in one. apply Rabs_def2 in two. rewrite impact in two.
  destruct (longer n) as [Bn _]. unfold rise in *. nra.
Qed.

End Fates.
